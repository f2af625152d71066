"use strict";
// Finds how the pictures fit into the window: with a whole number of pixels of the display for each of
// theirs, as anything else would blur or hide the noise, and side by side or one above the other.

const gap = 16;  // between two pictures and beside them, in pixels of the page

// Measures the parts of the task around its pictures, in pixels of the page.
function heightOfTexts(stacked) {
  const task = byId("task"), wasHidden = task.hidden, stages = byId("stages"), wasStacked = stages.classList.contains("stacked");
  stages.classList.toggle("stacked", stacked);
  task.classList.add("measured");
  task.hidden = false;
  const height = task.offsetHeight;
  task.hidden = wasHidden;
  task.classList.remove("measured");
  stages.classList.toggle("stacked", wasStacked);
  return height;
}

// Returns the room that both pictures need with so many pixels of the page for one of theirs.
function neededRoom(size, stacked) {
  const width = study.width * size, height = study.height * size, texts = heightOfTexts(stacked);
  return stacked ? {width: width + gap, height: 2 * height + gap + texts} : {width: 2 * width + 2 * gap, height: height + texts};
}

const fullScale = () => Math.max(1, Math.round(devicePixelRatio));

// Returns the arrangement with the largest pictures: {shown: pixels of the display for one of a
// picture, size: of the page, stacked}; null if there is none.
function arrangement() {
  for (let shown = fullScale(); shown >= 1; --shown)
    for (const stacked of [false, true]) {
      const size = shown / devicePixelRatio, needed = neededRoom(size, stacked);
      if (needed.width <= innerWidth && needed.height <= innerHeight) return {shown, size, stacked};
    }
  return null;
}

// Returns the space that the smallest arrangements need, in words.
function neededText() {
  const rooms = [false, true].map(stacked => neededRoom(1 / devicePixelRatio, stacked));
  return [...new Set(rooms.map(r => `${Math.ceil(r.width)} x ${Math.ceil(r.height)}`))].join(" / ");
}

// The size of a pixel of a picture in those of the page: a whole number of those of the display.
const pixelSize = () => arrangement()?.size ?? 1 / devicePixelRatio;
