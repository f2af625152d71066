"use strict";
// Fills the page of a render, whose data have totals as well.

const countOfBlocks = n => n === 1 ? "1 block" : `${showCount(n)} blocks`;

function sayRender(data) {
  const t = data.totals, all = t.blocks, open = all - t.cleanBlocks - t.blocksAtCap;
  const spp = data.images[0].blocks.map(b => b.spp), [least, most] = [Math.min(...spp), Math.max(...spp)];
  const each = (least === most ? showCount(least) : `${showCount(least)} to ${showCount(most)}`) + " samples per pixel";
  const start = `${t.interrupted ? "Interrupted after" : "Rendered in"} ${showSeconds(t.seconds)}: `;
  if (/^(fixed|thresholds)/.test(data.provenance.criterion)) return `${start}${each}, without a stopping rule.`;
  if (t.cleanBlocks === all) return `${start}${all === 1 ? "its only block is" : `all ${showCount(all)} blocks are`} clean, at ${each}.`;
  return start + [`${showCount(t.cleanBlocks)} of ${countOfBlocks(all)} ${t.cleanBlocks === 1 ? "is" : "are"} clean`,
    t.blocksAtCap ? `${showCount(t.blocksAtCap)} at the cap of ${showCount(data.cap)} samples per pixel, still noisy` : "",
    open ? `${showCount(open)} not finished` + (t.timeUp ? " in time" : "") : ""].filter(s => s).join("; ") + ".";
}

// The summary of a render.
function showTotals(data) {
  const t = data.totals;
  if (!t) return;
  byId("summary").hidden = false;
  byId("summary-tables").append(makeTable("", null, [
    ["clean blocks", `${t.cleanBlocks} of ${t.blocks}`],
    ...(t.blocksAtCap ? [["at the cap, still noisy", String(t.blocksAtCap)]] : []),
    ...(isNumber(t.neededCap) ? [["estimated maximum spp needed", showCount(t.neededCap) + " spp"]] : []),
    ["median sample count", showCount(t.medianSpp) + " spp"],
    ["samples", showCount(t.samples) + (t.samplesSaved >= 5e-4 ? `; ${showShare(t.samplesSaved)} fewer than with ${showCount(data.cap)} spp everywhere` : "")],
    ["wall-clock time", showSeconds(t.seconds)],
    ["CPU time", showSeconds(t.threadSeconds) + (t.secondsSaved >= 5e-4 ? `, about ${showShare(t.secondsSaved)} less than to the cap` : "")],
    ["CPU time of the rule", `${showSeconds(t.criterionSeconds)}, ${showShare(t.criterionSeconds / t.threadSeconds)}`],
    ...(t.rejectedSamples ? [["rejected samples", showCount(t.rejectedSamples)]] : [])]));
}

startPage("render", sayRender(data), [`stops by ${data.provenance.criterion}`],
  {sppName: () => "samples per pixel", sppHead: () => "spp", overlay: "none", summarise: () => showTotals(data)});  // the picture first
