"use strict";
// The check of the display: tones, gamma, zoom and size, whose results are stored with the answers, and whether the pictures fit.

const cardWidth = 85.6;  // mm, ISO/IEC 7810 ID-1

function makeWedge() {
  for (let i = 0; i < 16; ++i) {
    const v = Math.round(255 * i / 15);
    byId("wedge").append(make("span", {style: `background:rgb(${v},${v},${v})`}));
  }
}

// Black and white lines have half the light of white; the grey that looks like them says how the
// display turns values into light: (v / 255) ^ gamma = 1 / 2.
const gammaOf = grey => Math.log(0.5) / Math.log(grey / 255);

function showGamma() {
  const grey = +byId("gamma").value;
  byId("gamma-patch").style.background = `rgb(${grey},${grey},${grey})`;
  byId("gamma-value").textContent = "gamma " + gammaOf(grey).toFixed(2);
}

// The zoom of the page, where the browser tells: 1 is 100 %.
function pageZoom() {
  const zoom = outerWidth / innerWidth;
  return zoom > 0.2 && zoom < 6 ? zoom : null;
}

function showZoom() {
  byId("gamma-field").style.setProperty("--pixel", pixelSize() + "px");
  const zoom = pageZoom(), shown = Math.round(pixelSize() * devicePixelRatio);
  const off = zoom !== null && Math.abs(zoom - 1) > 0.06;
  byId("zoom").textContent = off ? `The page seems to be zoomed to ${Math.round(100 * zoom)} %. Press Ctrl and 0 to set it to 100 %.`
    : `The zoom is 100 %, as it should be; a pixel of a picture is ${shown}x${shown} of the display, whatever its scale (${Math.round(100 * devicePixelRatio)} %).`;
  byId("zoom").classList.toggle("warning", off);
}

const tooSmallText = () => `The pictures do not fit: they need ${neededText()} pixels, and this window has ${innerWidth} x ${innerHeight}. Make it larger, by full screen for instance, or take a larger display. They are not made smaller, as that would hide their noise.`;

// Says whether the pictures fit, and lets nobody begin where they do not.
function showWindow() {
  const found = arrangement(), full = fullScale();
  byId("window").textContent = !found ? tooSmallText()
    : found.shown < full ? `The pictures fit into this window of ${innerWidth} x ${innerHeight} pixels with ${found.shown}x${found.shown} of its pixels for one of a picture, in place of ${full}x${full}.`
    : `The pictures fit into this window; it has ${innerWidth} x ${innerHeight} pixels.`;
  byId("window").classList.toggle("warning", !found);
  byId("begin").disabled = !found;
}

function showCard() {
  byId("card").style.width = byId("card-size").value + "px";
}

function makeCheck() {
  makeWedge();
  byId("gamma").addEventListener("input", showGamma);
  byId("card-size").addEventListener("input", showCard);
  addEventListener("resize", () => { showZoom(); showWindow(); });
  byId("full-check").addEventListener("click", toggleFullScreen);
  showGamma();
  showZoom();
  showWindow();
  showCard();
}

const chosen = name => document.querySelector(`input[name=${name}]:checked`)?.value ?? null;

// Returns the data of the display and the viewing conditions. Pixels are those of pictures.
function displayFacts() {
  const found = arrangement();
  const pixelsPerMm = byId("card-touched").checked ? byId("card-size").value / cardWidth / pixelSize() : null;
  const distance = +byId("distance").value;
  return {userAgent: navigator.userAgent, screen: [screen.width, screen.height], window: [innerWidth, innerHeight],
    devicePixelRatio, zoom: pageZoom(), colorDepth: screen.colorDepth, tones: chosen("tones"),
    shown: found?.shown ?? null, arrangement: !found ? null : !found.stacked ? "side by side" : "one above the other",
    gamma: +gammaOf(+byId("gamma").value).toFixed(3), distanceCm: distance, pixelsPerMm,
    pixelsPerDegree: pixelsPerMm ? +(pixelsPerMm * 10 * distance * Math.PI / 180).toFixed(1) : null};
}

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
