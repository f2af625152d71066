"use strict";
// Decodes the pictures of blocks, and keeps those that may be shown next.

const pictureLists = new Map();   // block: list of pictures in base64, one a level
const decodedPictures = new Map();  // "block/level": promise of an image

function pictureList(block) {
  if (!pictureLists.has(block)) pictureLists.set(block, JSON.parse(byId("pictures-" + block).textContent));
  return pictureLists.get(block);
}

// Returns a promise of the image of a block at a level, ready to be drawn.
function pictureOf(block, level) {
  const key = block + "/" + level;
  if (!decodedPictures.has(key)) {
    const image = new Image();
    image.src = "data:image/png;base64," + pictureList(block)[level];
    decodedPictures.set(key, image.decode().then(() => image));
  }
  return decodedPictures.get(key);
}

// Lets go of pictures but those that `isWanted(block, level)`.
function forgetPictures(isWanted) {
  for (const key of [...decodedPictures.keys()])
    if (!isWanted(...key.split("/").map(Number))) decodedPictures.delete(key);
}

// Draws a block at a level on a canvas of its own; the last call for a canvas wins. Resolves once
// it is there.
async function drawPicture(canvas, block, level) {
  const key = block + "/" + level;
  if (canvas.dataset.shows === key) return;
  canvas.dataset.shows = key;
  const image = await pictureOf(block, level);
  if (canvas.dataset.shows !== key) return;
  if (canvas.width !== image.naturalWidth) canvas.width = image.naturalWidth;
  if (canvas.height !== image.naturalHeight) canvas.height = image.naturalHeight;
  canvas.getContext("2d").drawImage(image, 0, 0);
}

// Gives a canvas the size of a block.
function sizeCanvas(canvas, block) {
  const b = study.blocks[block], size = pixelSize();
  Object.assign(canvas.style, {width: b.width * size + "px", height: b.height * size + "px"});
}

// Moves an element, which has to be positioned, to where a pixel of the display begins: between two of
// them the browser would leave out or double a row of the picture.
function alignToDisplay(element) {
  element.style.left = element.style.top = "0";
  const at = element.getBoundingClientRect();
  const rest = v => Math.round(v * devicePixelRatio) / devicePixelRatio - v;
  element.style.left = rest(at.left + scrollX) + "px";
  element.style.top = rest(at.top + scrollY) + "px";
}
