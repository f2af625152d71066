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
    open ? `${showCount(open)} ${t.timeUp ? "out of time" : "interrupted"}` : ""].filter(s => s).join("; ") + ".";
}

// Returns the savings in samples and in CPU time compared with the highest sample count of a block everywhere; of an image
// with all its blocks.
function savingsOf(data) {
  const [{blocks}] = data.images, most = Math.max(...blocks.map(b => b.spp));
  const sum = value => blocks.reduce((total, b, i) => total + value(b, data.blocks[i].width * data.blocks[i].height), 0);
  const share = (taken, whole) => whole > 0 ? 1 - taken / whole : 0;
  return {most, samples: share(sum((b, area) => b.spp * area), sum((b, area) => most * area)),
    seconds: share(sum(b => b.seconds), sum(b => b.spp > 0 ? b.seconds / b.spp * most : 0))};
}

// The summary of a render.
function showTotals(data) {
  const t = data.totals;
  if (!t) return;
  const saved = t.interrupted || t.timeUp ? {} : savingsOf(data);
  byId("summary").hidden = false;
  byId("summary-tables").append(makeTable("", null, [
    ["clean blocks", `${t.cleanBlocks} of ${t.blocks}`],
    ...(t.blocksAtCap ? [["at the cap, still noisy", String(t.blocksAtCap)]] : []),
    ...(isNumber(t.neededCap) ? [["estimated maximum spp needed", showCount(t.neededCap) + " spp"]] : []),
    ["median sample count", showCount(t.medianSpp) + " spp"],
    ["samples", showCount(t.samples) + (saved.samples >= 5e-4 ? `; ${showShare(saved.samples)} fewer than with ${showCount(saved.most)} spp everywhere` : "")],
    ["wall-clock time", showSeconds(t.seconds)],
    ["CPU time", showSeconds(t.threadSeconds) + (saved.seconds >= 5e-4 ? `, about ${showShare(saved.seconds)} less` : "")],
    ["CPU time of the rule", `${showSeconds(t.criterionSeconds)}, ${showShare(t.criterionSeconds / t.threadSeconds)}`],
    ...(t.rejectedSamples ? [["rejected samples", showCount(t.rejectedSamples)]] : [])]));
}

startPage("render", sayRender(data), [`stopping rule: ${ruleLabel(data.provenance.criterion)}`],
  {sppName: () => "samples per pixel", sppHead: () => "spp", overlay: "none", summarise: () => showTotals(data)});  // the picture first
