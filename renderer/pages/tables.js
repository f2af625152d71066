"use strict";
// Fills in the figures and curves of a block, and the tables.

const figureNames = [["rmse", "RMSE"], ["relMse", "relMSE"], ["rmseLightness", "RMSE, L*"],
                     ["psnr", "PSNR, dB"], ["ssim", "SSIM"], ["flip", "FLIP"],
                     ["visibleDifference", "visible difference"]];
// An image that is the same as the reference has an infinite PSNR, which JSON cannot hold.
const showFigure = (figures, name) =>
  name === "psnr" && figures && figures.psnr === null && figures.rmseLightness === 0 ? "\u221e" : show(figures && figures[name], name === "ssim" ? 5 : 4);
const blockEnds = {stopped: "clean: stopped by the rule", cap: "at the cap, still noisy", interrupted: "interrupted", time: "out of time"};
const compared = data => data.images.filter(i => i.figures);

// Returns the difference of a block to its human threshold, as text.
function differenceToHuman(data, i) {
  const difference = data.againstHuman && data.againstHuman.spp[i];
  if (!isNumber(difference)) return null;
  return difference === 0 ? "equal" : `${showCount(Math.abs(difference))} spp ${difference < 0 ? "earlier" : "later"}`;
}

function showBlock(data, i) {
  const block = data.blocks[i];
  byId("block").hidden = false;
  byId("block-title").textContent = `Block ${i} (${block.width}\u00d7${block.height} pixels at ${block.x}, ${block.y})`;
  byId("curves-title").textContent = `Curves of block ${i}`;
  const images = data.images.filter(m => m.blocks && m.blocks[i]);
  const rows = [];
  const add = (label, has, text) => { if (images.some(m => has(m.blocks[i]))) rows.push([label, ...images.map(m => has(m.blocks[i]) ? text(m.blocks[i]) : "\u2013")]); };
  add("samples per pixel", b => isNumber(b.spp), b => showCount(b.spp));
  add("CPU time", b => b.seconds > 0, b => (b.estimated ? "~" : "") + showSeconds(b.seconds));
  add("CPU time of the rule", b => b.ruleSeconds > 0, b => showSeconds(b.ruleSeconds));
  for (const [name, label] of figureNames) add(label, b => name in b, b => showFigure(b, name));
  const difference = differenceToHuman(data, i);
  if (difference) rows.push(["compared with human threshold", difference, ...images.slice(1).map(() => "")]);
  if (block.people) rows.push(["human threshold, 80 % range", (isNumber(block.people.to) ? `${showCount(block.people.from)} to ${showCount(block.people.to)}` : `${showCount(block.people.from)} or more`) + " spp"]);
  if (block.end) rows.push(["end", blockEnds[block.end]]);
  if (isNumber(block.visibleNoise)) rows.push(["visible noise, L*", block.visibleNoise.toFixed(2)]);
  if (block.visibleDifference) rows.push(["visible difference, denoised", `${block.visibleDifference.estimate.toFixed(1)}, upper bound ${block.visibleDifference.upper.toFixed(1)}`]);
  if (block.end === "cap" && isNumber(block.neededSpp)) rows.push(["estimated stop", `${showCount(block.neededSpp)} spp`]);
  if (isNumber(block.neededSeconds)) rows.push(["missing CPU time (estimate)", `~${showSeconds(block.neededSeconds)}`]);
  byId("block-facts").replaceChildren(makeTable("", images.length > 1 ? ["", ...images.map(m => m.name)] : null, rows));

  const lines = data.images.filter(m => m.blocks && m.blocks[i] && m.name !== data.reference && isNumber(m.blocks[i].spp))
    .map((m, k) => ({x: m.blocks[i].spp, label: m.name, colour: palette[k === 0 ? 1 : 2]}));
  const parent = byId("block-charts");
  parent.replaceChildren();
  const rule = (data.provenance || {}).criterion || "";
  if (block.decisions && !/^(fixed|thresholds)/.test(rule)) {  // those only count
    const d = block.decisions, learned = /^learned/.test(rule);
    drawChart(parent, [
      {label: learned ? "P(noisy)" : "value", x: d.spp, y: d.value, colour: palette[0], mark: 0},
      {label: "threshold", x: d.spp, y: d.spp.map(() => d.threshold), dash: [2, 4]}
    ], {title: learned ? "Probability that an observer sees noise" : `Value of the stopping rule (${rule})`,
        xLabel: "samples per pixel", yLabel: learned ? "probability" : "value", logY: !learned, yRange: learned ? [0, 1] : null, lines});
  }
  if (block.curves && block.curves.spp.length) {
    const c = block.curves;
    drawChart(parent, [{label: "noise", x: c.spp, y: c.noise, colour: palette[1], mark: 1}],
      {title: "Visible noise, L*", xLabel: "samples per pixel", yLabel: "noise, L*", logY: true, lines});
    const low = Math.min(...c.entropy), high = Math.max(...c.entropy), room = Math.max(0.002, 0.1 * (high - low));
    drawChart(parent, [{label: "entropy", x: c.spp, y: c.entropy, colour: palette[2], mark: 2}],
      {title: "SVD-entropy, mean of 100 sub-blocks", xLabel: "samples per pixel", yLabel: "entropy", yRange: [low - room, high + room], lines});
  }
  byId("curves").hidden = !parent.children.length;
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
  for (const [name, label] of figureNames) add(label, i => i.figures && showFigure(i.figures, name));
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

// The summary of a render.
function showTotals(data) {
  const t = data.totals;
  if (!t) return;
  byId("totals").hidden = false;
  byId("totals-table").append(makeTable("", null, [
    ["clean blocks", `${t.stoppedBlocks} of ${t.blocks}`],
    ...(t.blocksAtCap ? [["at the cap, still noisy", String(t.blocksAtCap)]] : []),
    ...(isNumber(t.neededCap) ? [["estimated maximum spp needed", showCount(t.neededCap) + " spp"]] : []),
    ["median sample count", showCount(t.medianSpp) + " spp"],
    ["samples", showCount(t.samples) + (t.samplesSaved >= 5e-4 ? `; ${showShare(t.samplesSaved)} fewer than with ${showCount(data.cap)} spp everywhere` : "")],
    ["wall-clock time", showSeconds(t.seconds)],
    ["CPU time", showSeconds(t.threadSeconds) + (t.secondsSaved >= 5e-4 ? `, about ${showShare(t.secondsSaved)} less than to the cap` : "")],
    ["CPU time of the rule", `${showSeconds(t.criterionSeconds)}, ${showShare(t.criterionSeconds / t.threadSeconds)}`],
    ...(t.rejectedSamples ? [["rejected samples", showCount(t.rejectedSamples)]] : [])]));
}

function showBlocksTable(data) {
  const images = data.images.filter(i => i.blocks && i.blocks.length && i.name !== data.reference);
  if (!data.blocks.length || !images.length) return;
  byId("blocks").hidden = false;
  const head = ["block"], cells = [];
  for (const image of images) {
    head.push(data.kind === "render" ? "spp" : `spp of ${image.name}`);
    cells.push(i => showCount(image.blocks[i].spp));
    if (image.blocks[0].seconds > 0) { head.push("CPU time, s"); cells.push(i => (image.blocks[i].estimated ? "~" : "") + show(image.blocks[i].seconds, 3)); }
    if (image.figures) for (const [name, label] of figureNames) if (name !== "rmse") { head.push(label); cells.push(i => showFigure(image.blocks[i], name)); }
  }
  if (data.againstHuman) { head.push("compared with human threshold"); cells.push(i => differenceToHuman(data, i)); }
  if (data.blocks[0].end) { head.push("end"); cells.push(i => blockEnds[data.blocks[i].end].split(/[:,]/)[0]); }
  const table = makeTable("", head, data.blocks.map((b, i) => [String(i), ...cells.map(c => c(i))]));
  [...table.tBodies[0].rows].forEach((row, i) => row.addEventListener("click", () => chooseBlock(i)));
  byId("blocks-table").append(withCsv(table, "blocks"));
}

function showProvenance(data) {
  byId("notes").append(...(data.notes || []).map(n => make("li", {}, n)),
    ...Object.entries(data.warnings || {}).map(([kind, count]) => make("li", {}, `Warning, ${count} times: ${kind}`)));
  const rows = Object.entries(data.provenance || {}).filter(([, v]) => v !== "").map(([k, v]) =>
    [k, v && typeof v === "object" ? Object.entries(v).map(([a, b]) => Array.isArray(v) ? b : `${a} ${b}`).join(", ") : String(v)]);
  if (rows.length) byId("provenance-table").replaceChildren(makeTable("", null, rows).querySelector("tbody"));
  byId("provenance").hidden = !rows.length && !byId("notes").children.length;
}
