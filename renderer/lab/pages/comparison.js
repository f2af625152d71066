"use strict";
// Fills the page of a comparison, whose data have as well:
//   images [{flipSrc?, visibleDifferenceSrc?, visibleBlocks?, figures?, eyes? {left, right}, seams?, cost?, saved?,
//            blocks [{figures}]}]
//   viewing {name, pixelsPerDegree, threshold}: for visible differences, with the visibility threshold
//   againstHuman, estimates, verifications
//   errorCurves? {sharesReference, points [{rule, setting, spp, seconds, ruleSeconds, and figures}]}

const figureNames = [["rmse", "RMSE"], ["relMse", "relMSE"], ["rmseLightness", "RMSE, L*"],
                     ["psnr", "PSNR, dB"], ["ssim", "SSIM"], ["flip", "FLIP"],
                     ["visibleDifference", "visible difference"]];
// An image that is the same as the reference has an infinite PSNR, which JSON cannot hold.
const showFigure = (figures, name) =>
  name === "psnr" && figures && figures.psnr === null && figures.rmseLightness === 0 ? "\u221e" : show(figures && figures[name], name === "ssim" ? 5 : 4);

// Returns the difference of a block to its human threshold, as text.
function differenceToHuman(data, i) {
  const difference = data.againstHuman && data.againstHuman.spp[i];
  if (!isNumber(difference)) return null;
  return difference === 0 ? "equal" : `${showCount(Math.abs(difference))} spp ${difference < 0 ? "earlier" : "later"}`;
}

function sayComparison(data) {
  const [image] = data.images, f = image.figures, h = data.againstHuman;
  const than = share => `${showShare(Math.abs(share))} ${share < 0 ? "more" : "fewer"} samples than`;
  const parts = [];
  if (f && isNumber(f.rmseLightness)) parts.push(f.rmseLightness === 0 ? `equals the ${data.reference}` : `differs from the ${data.reference} by ${show(f.rmseLightness, 3)} L* (RMSE)`);
  if (image.saved && isNumber(image.saved.samples)) parts.push(`has ${than(image.saved.samples)} at ${showCount(data.cap)} everywhere`);
  if (h && isNumber(h.savedSamples)) parts.push(h.savedSamples === 0 ? "has as many samples as the human thresholds" : `has ${than(h.savedSamples)} the human thresholds`);
  if (!parts.length) return "";
  return `The image \u201c${image.name}\u201d ${parts.length > 1 ? parts.slice(0, -1).join(", ") + " and " : ""}${parts[parts.length - 1]}.`;
}

// A column for each image.
function showSummary(data) {
  const parent = byId("summary-tables");
  const images = data.images.filter(i => i.figures || i.cost || i.seams);
  const rows = [];
  const add = (label, text) => { const cells = images.map(i => text(i) || "\u2013"); if (cells.some(c => c !== "\u2013")) rows.push([label, ...cells]); };
  const roughly = (isEstimated, text) => (isEstimated && text !== "\u2013" ? "~" : "") + text;
  const saved = i => i.name !== data.reference && i.saved;
  add("rule", i => i.rule && i.rule.replace(/[:/]/g, "$&\u200b"));  // it can break there
  add("mean spp", i => i.cost && show(i.cost.samples / (data.width * data.height), 4));
  add("samples", i => i.cost && showCount(i.cost.samples));
  add("samples saved", i => saved(i) && showShare(i.saved.samples));
  add("CPU time", i => i.cost && i.cost.seconds > 0 && roughly(i.cost.estimated, showSeconds(i.cost.seconds)));
  add("CPU time saved", i => saved(i) && roughly(i.saved.estimated, showShare(i.saved.seconds)));
  add("fraction of the rule", i => i.cost && i.cost.seconds > 0 && showShare(i.cost.ruleSeconds / (i.cost.seconds + i.cost.ruleSeconds)));
  for (const [name, label] of figureNames) {
    add(label, i => i.figures && showFigure(i.figures, name));
    for (const eye of ["left", "right"]) add(`\u2003${eye} eye`, i => i.eyes && showFigure(i.eyes[eye], name));
  }
  add("blocks that differ visibly", i => i.figures && `${i.visibleBlocks} of ${data.blocks.length}`);
  add("seams", i => i.seams && show(i.seams.ratio, 3));
  if (rows.length) parent.append(withCsv(makeTable("", ["", ...images.map(i => i.name)], rows), "summary"));
  const notes = [];
  if (images.some(i => i.figures)) notes.push("Errors are against the reference; PSNR, SSIM, FLIP and visible differences of the 8-bit image.",
    `Visible differences: ColorVideoVDP with the sensitivity of castleCSF, on a display of ${data.viewing.name}. A block differs visibly above ${show(data.viewing.threshold)}.`);
  if (images.some(i => i.seams)) notes.push("Seams: jump in noise level across block borders / inside blocks; 1: none.");
  if (images.some(i => i.cost && i.cost.estimated || i.saved && i.saved.estimated)) notes.push("~ marks estimates from the CPU time per sample of each block.");
  if (notes.length) parent.append(make("p", {class: "small"}, notes.join(" ")));
  const h = data.againstHuman;
  if (h) parent.append(make("p", {}, `Automatic against human: ${h.earlier} blocks earlier, ${h.later} later, ${showCount(h.meanDistance)} spp apart on average; ${showShare(Math.abs(h.savedSamples))} ${h.savedSamples < 0 ? "more" : "fewer"} samples.`));
  const e = data.estimates;
  if (e && e.blocks) parent.append(make("p", {}, `Estimated CPU time to the cap of ${e.blocks} stopped blocks: ${showShare(e.total)} off the measured time in total, ${showShare(e.worst)} in the worst block.`));
  const v = data.verifications || [];
  if (v.length)
    parent.append(makeTable("The automatic image rendered by itself", ["threads", ...v.map(o => String(o.threads))], [
      ["wall-clock time", ...v.map(o => showSeconds(o.wallSeconds))], ["to the cap (estimated)", ...v.map(o => showSeconds(o.wallSecondsToCap))],
      ["time saved", ...v.map(o => showShare(o.savedWall))], ["time saved / samples saved", ...v.map(o => showShare(o.kept))],
      ["fraction of the rule", ...v.map(o => showShare(o.ruleShare))], ["pixels", ...v.map(o => o.samePixels ? "the same bits" : "DIFFERENT")]]));
  byId("summary").hidden = !parent.children.length;
}

// The maps of errors.
function errorLayers() {
  const maps = [];
  for (const image of data.images)
    if (image.flipSrc) maps.push({label: "FLIP error of " + image.name, src: image.flipSrc, ends: ["0", "FLIP: visible difference, 0 to 1", "1"]});
  for (const image of data.images)
    if (image.visibleDifferenceSrc) maps.push({label: "Visible difference of " + image.name, src: image.visibleDifferenceSrc,
      ends: ["0", `visible difference; visibility threshold ${show(data.viewing.threshold)} in the middle`, "\u221e"]});
  return maps;
}

// How much longer the rule went on than people asked for: colours by the ratio, a factor of four at
// the ends.
function humanOverlay() {
  const [a, h] = ["automatic", "human"].map(name => data.images.find(i => i.name === name).blocks);
  return {name: "human", label: "difference to human", numbers: {
    values: a.map((b, i) => b.spp - h[i].spp), places: a.map((b, i) => 0.5 + Math.log2(b.spp / h[i].spp) / 4),
    colour: diverging, ends: ["4 times earlier", "automatic against human: difference in samples per pixel", "4 times later"],
    show: v => (v > 0 ? "+" : v < 0 ? "\u2212" : "\u00b1") + Math.abs(v)}};
}

function blockRows(i, images, add, rows) {
  for (const [name, label] of figureNames) add(label, b => name in b, b => showFigure(b, name));
  const difference = differenceToHuman(data, i);
  if (difference) rows.push(["compared with human threshold", difference, ...images.slice(1).map(() => "")]);
}

function blockColumns(image, head, cells) {
  if (image.figures) for (const [name, label] of figureNames) if (name !== "rmse") { head.push(label); cells.push(i => showFigure(image.blocks[i], name)); }
}

function lastColumns(head, cells) {
  if (data.againstHuman) { head.push("compared with human threshold"); cells.push(i => differenceToHuman(data, i)); }
}

// Draws error against effort: lines for fixed samples per pixel, marks for stopping rules.

const curveErrors = [["rmseLightness", "RMSE of L"], ["relMse", "relMSE"], ["dssim", "1 \u2212 SSIM"], ["flip", "FLIP"], ["visibleDifference", "visible difference"], ["rmse", "RMSE"]];
const curveEfforts = [["seconds", "seconds"], ["spp", "mean samples per pixel"]];

// Says whether most samples of the reference are a point's own, which tells little of its error.
const isTooNear = (data, p) => data.errorCurves.sharesReference && p.spp > data.cap / 2;

function curveSeries(data, error, effort) {
  const rules = [...new Set(data.errorCurves.points.map(p => p.rule))];
  return rules.map((rule, k) => {
    const points = data.errorCurves.points.filter(p => p.rule === rule && isNumber(p[error]) && p[error] > 0 && isNumber(p[effort]) && !isTooNear(data, p)).sort((a, b) => a[effort] - b[effort]);
    return {label: rule, x: points.map(p => p[effort]), y: points.map(p => p[error]), colour: palette[k % palette.length],
      mark: rule === "fixed" ? null : (k + 4) % 5, line: points.length > 1};
  }).filter(s => s.x.length);
}

// The visibility threshold, as a line from the least effort to the most.
function thresholdSeries(data, error, effort) {
  if (error !== "visibleDifference") return [];
  const x = data.errorCurves.points.map(p => p[effort]).filter(isNumber), ends = [Math.min(...x), Math.max(...x)];
  return [{label: "visibility threshold", x: ends, y: ends.map(() => data.viewing.threshold), colour: "gray", dash: [2, 4], line: true}];
}

function startErrorCurves(data) {
  if (!data.errorCurves) return;
  byId("error-curves").hidden = false;
  for (const p of data.errorCurves.points) p.dssim = isNumber(p.ssim) ? 1 - p.ssim : null;
  let error = "rmseLightness";
  const draw = () => {
    const parent = byId("error-charts");
    parent.replaceChildren();
    const label = curveErrors.find(e => e[0] === error)[1];
    for (const [effort, name] of curveEfforts)
      drawChart(parent, [...curveSeries(data, error, effort), ...thresholdSeries(data, error, effort)], {title: `${label} against ${name}`, xLabel: name, yLabel: label, logY: true, height: 420, endsVary: true});
    fitCharts();
  };
  byId("error-controls").append(makeChoice("Error", curveErrors, error, v => { error = v; draw(); }));
  draw();
  if (data.errorCurves.points.some(p => isTooNear(data, p)))
    byId("error-table").append(make("p", {class: "small"}, "Left out of the charts: points of which the reference shares the samples, beyond half the cap."));
  const table = makeTable("All points", ["rule", "setting", "mean spp", "seconds", "RMSE of L", "relMSE", "SSIM", "FLIP", "visible"],
    data.errorCurves.points.map(p => [p.rule, String(p.setting ?? ""), show(p.spp), show(p.seconds), show(p.rmseLightness), show(p.relMse), show(p.ssim, 5), show(p.flip), show(p.visibleDifference)]));
  byId("error-table").append(make("div", {class: "scroll"}, withCsv(table, "points")));
}

startErrorCurves(data);
startPage("compare", sayComparison(data), [],
  {noun: "comparison", sppName: image => "spp of " + image.name, sppHead: image => "spp of " + image.name, layers: errorLayers(),
   overlays: data.againstHuman ? [humanOverlay()] : [], isDivided: true, blockRows, blockColumns, lastColumns,
   summarise: () => showSummary(data)});
