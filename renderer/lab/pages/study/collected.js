"use strict";
// Shows the thresholds of people on the image, where they disagree, and who was left out:
//   viewpoints [{name, observers, levels [], width?, height?, references? [src],
//     places? [{x, y, width, height}], blocks [{mean, lowest, highest, deviation, octaves, answers}],
//     fewestAnswers, enoughAnswers}]
//   observers [{file, observer, viewpoint, leftOut, doubts, checks, failed, repeats,
//     repeatOctaves, shiftOctaves, seconds, gamma, distanceCm}],  refused [{file, reason}]

const data = JSON.parse(byId("data").textContent);
const showOctaves = v => isNumber(v) ? v.toFixed(2) : "\u2013";

// Overlays of the image: values, their places in [0, 1], and words for them.
function overlaysOf(viewpoint) {
  const low = viewpoint.levels[0], high = viewpoint.levels[viewpoint.levels.length - 1];
  const widest = Math.max(0.5, ...viewpoint.blocks.map(b => b.octaves || 0));
  return {
    thresholds: {values: viewpoint.blocks.map(b => showCount(b.mean)), places: viewpoint.blocks.map(b => Math.log(b.mean / low) / Math.log(high / low)),
      ends: [showCount(low), "mean threshold in samples per pixel (logarithmic)", showCount(high)]},
    disagreement: {values: viewpoint.blocks.map(b => showOctaves(b.octaves)), places: viewpoint.blocks.map(b => (b.octaves || 0) / widest),
      ends: ["0", "standard deviation over observers, in octaves (1: a factor of two)", showOctaves(widest)]},
  };
}

function drawViewpointOverlay(viewpoint, svg, legend, name) {
  svg.replaceChildren();
  legend.replaceChildren();
  const overlay = overlaysOf(viewpoint)[name];
  if (!overlay) return;
  viewpoint.places.forEach((p, i) => {
    const place = overlay.places[i], size = Math.min(p.width / 5, p.height / 4, viewpoint.width / 30);
    svg.append(make("rect", {...p, class: "shade", style: `fill:${viridis(place)}`}),
      make("text", {x: p.x + p.width / 2, y: p.y + p.height / 2, "font-size": size}, overlay.values[i]));
  });
  legend.append(...makeScale(viridis, overlay.ends));
}

function makePicture(viewpoint) {
  const part = (a, whole) => 100 * a / whole + "%";
  const svg = make("svg", {viewBox: `0 0 ${viewpoint.width} ${viewpoint.height}`, role: "img", "aria-label": "Thresholds of the blocks; the table below has them too"});
  const legend = make("div", {class: "legend"});
  const picture = make("div", {class: "picture", style: `aspect-ratio:${viewpoint.width}/${viewpoint.height}`},
    ...viewpoint.places.map((p, i) => make("img", {src: viewpoint.references[i], alt: "", style:
      `left:${part(p.x, viewpoint.width)};top:${part(p.y, viewpoint.height)};width:${part(p.width, viewpoint.width)};height:${part(p.height, viewpoint.height)}`})), svg);
  const choice = makeChoice("Over the image", [["thresholds", "thresholds"], ["disagreement", "where observers disagree"], ["none", "nothing"]],
    "thresholds", name => drawViewpointOverlay(viewpoint, svg, legend, name));
  drawViewpointOverlay(viewpoint, svg, legend, "thresholds");
  return make("div", {style: `--width:${Math.max(viewpoint.width, 600)}px`}, make("p", {class: "controls"}, choice), picture, legend);
}

function makeViewpoint(viewpoint) {
  const rows = viewpoint.blocks.map((b, i) => [String(i), showCount(b.mean), `${showCount(b.lowest)} \u2013 ${showCount(b.highest)}`, show(b.deviation, 3), showOctaves(b.octaves), String(b.answers)]);
  return make("section", {}, make("h2", {}, viewpoint.name),
    make("p", {}, `${viewpoint.observers} observer${viewpoint.observers === 1 ? "" : "s"}.`),
    viewpoint.fewestAnswers < viewpoint.enoughAnswers
      ? make("p", {}, `Thresholds of blocks rest on as few as ${viewpoint.fewestAnswers} answer${viewpoint.fewestAnswers === 1 ? "" : "s"}: they are rough with fewer than ${viewpoint.enoughAnswers}.`) : null,
    make("div", {class: "beside"},
      viewpoint.references ? makePicture(viewpoint) : make("p", {class: "hint"}, "--study STUDY.html shows the image here."),
      make("div", {class: "scroll"}, makeTable("Samples per pixel at which noise is no longer seen", ["block", "mean", "lowest \u2013 highest", "deviation", "octaves", "answers"], rows))));
}

// The second column has words.
const wordsIn = table => { for (const row of table.rows) row.cells[1].classList.add("words"); return table; };

function makeObservers() {
  const table = makeTable("", ["observer", "counts", "viewpoint", "checks failed", "asked twice", "deviation of an answer, octaves", "above all, octaves", "time", "gamma", "distance, cm"],
    data.observers.map(o => [o.observer, o.leftOut ? "left out: " + o.leftOut : o.doubts ? "yes, but " + o.doubts : "yes", o.viewpoint, `${o.failed} of ${o.checks}`,
      String(o.repeats), showOctaves(o.repeatOctaves), showOctaves(o.shiftOctaves), showSeconds(o.seconds), show(o.gamma, 3), show(o.distanceCm, 3)]));
  [...table.tBodies[0].rows].forEach((row, i) => row.classList.toggle("left-out", data.observers[i].leftOut !== ""));
  return make("section", {}, make("h2", {}, "Observers"), make("div", {class: "scroll"}, wordsIn(table)));
}

byId("subtitle").textContent = `${data.observers.filter(o => !o.leftOut).length} of ${data.observers.length + data.refused.length} files of answers count`;
byId("all").append(...data.viewpoints.map(makeViewpoint), makeObservers());
if (data.refused.length)
  byId("all").append(make("section", {}, make("h2", {}, "Files that were refused"),
    make("div", {class: "scroll"}, wordsIn(makeTable("", ["file", "why"], data.refused.map(r => [r.file, r.reason]))))));
