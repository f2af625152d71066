"use strict";
// The check of the display: tones, gamma, zoom and size. What is found goes with the answers.

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
  byId("gamma-value").textContent = `gamma ${gammaOf(grey).toFixed(2)}`;
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
  const pixels = `a pixel of a picture is ${shown === 1 ? "one" : shown + "x" + shown} of the display, whatever its scale (${Math.round(100 * devicePixelRatio)} %)`;
  byId("zoom").textContent = off
    ? `The page seems to be zoomed to ${Math.round(100 * zoom)} %. Press Ctrl and 0 to set it to 100 %.`
    : `The zoom is 100 %, as it should be; ${pixels}.`;
  byId("zoom").classList.toggle("warning", off);
}

function showCard() {
  byId("card").style.width = byId("card-size").value + "px";
}

function makeCheck() {
  makeWedge();
  byId("gamma").addEventListener("input", showGamma);
  byId("card-size").addEventListener("input", showCard);
  addEventListener("resize", showZoom);
  showGamma();
  showZoom();
  showCard();
}

// Returns what is known of the display and of how it is looked at.
function displayFacts() {
  const tones = document.querySelector("input[name=tones]:checked");
  const pixelsPerMm = byId("card-touched").checked ? byId("card-size").value / cardWidth : null;
  const distance = +byId("distance").value;
  return {userAgent: navigator.userAgent, screen: [screen.width, screen.height], window: [innerWidth, innerHeight],
    devicePixelRatio, zoom: pageZoom(), colorDepth: screen.colorDepth, tones: tones ? tones.value : null,
    gamma: +gammaOf(+byId("gamma").value).toFixed(3), distanceCm: distance, pixelsPerMm,
    pixelsPerDegree: pixelsPerMm ? +(pixelsPerMm * 10 * distance * Math.PI / 180).toFixed(1) : null};
}
