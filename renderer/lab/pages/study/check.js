"use strict";
// The check of the display: tones, gamma, zoom and size. Its results are stored with the answers.

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
