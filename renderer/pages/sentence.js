"use strict";
// Says in one sentence what a page is about.

const countOfBlocks = n => n === 1 ? "1 block" : `${showCount(n)} blocks`;

function sayRender(data) {
  const t = data.totals, all = t.blocks, open = all - t.stoppedBlocks - t.blocksAtCap;
  const spp = data.images[0].blocks.map(b => b.spp), [least, most] = [Math.min(...spp), Math.max(...spp)];
  const each = (least === most ? showCount(least) : `${showCount(least)} to ${showCount(most)}`) + " samples per pixel";
  const start = `${t.interrupted ? "Interrupted after" : "Rendered in"} ${showSeconds(t.seconds)}: `;
  if (/^(fixed|thresholds)/.test(data.provenance.criterion)) return `${start}${each}, without looking for noise.`;
  if (t.stoppedBlocks === all) return `${start}${all === 1 ? "its only block is" : `all ${showCount(all)} blocks are`} clean, at ${each}.`;
  return start + [`${showCount(t.stoppedBlocks)} of ${countOfBlocks(all)} ${t.stoppedBlocks === 1 ? "is" : "are"} clean`,
    t.blocksAtCap ? `${showCount(t.blocksAtCap)} went to the cap of ${showCount(data.cap)} samples per pixel, still noisy` : "",
    open ? `${showCount(open)} not done` + (t.timeUp ? " when the time was up" : "") : ""].filter(s => s).join("; ") + ".";
}

function sayComparison(data) {
  const [image] = data.images, f = image.figures, h = data.againstHuman;
  const than = share => `${showShare(Math.abs(share))} ${share < 0 ? "more" : "fewer"} samples than`;
  const parts = [];
  if (f && isNumber(f.rmseLightness)) parts.push(f.rmseLightness === 0 ? `shows what the ${data.reference} does` : `is ${show(f.rmseLightness, 3)} off the ${data.reference} in lightness (RMSE, of 0 to 100)`);
  if (image.saved && isNumber(image.saved.samples)) parts.push(`has ${than(image.saved.samples)} at ${showCount(data.cap)} everywhere`);
  if (h && isNumber(h.savedSamples)) parts.push(h.savedSamples === 0 ? "has as many samples as people asked for" : `has ${than(h.savedSamples)} people asked for`);
  if (!parts.length) return "";
  return `The image \u201c${image.name}\u201d ${parts.length > 1 ? parts.slice(0, -1).join(", ") + " and " : ""}${parts[parts.length - 1]}.`;
}

function sayBench(data) {
  const rules = [...new Set(data.bench.points.map(p => p.rule))].filter(r => r !== "fixed");
  return (rules.length ? `${rules.join(", ")} beside` : "Error of") + ` fixed samples per pixel: ${data.bench.points.length} points, against a reference of ${showCount(data.cap)}.`;
}

const saySentence = data => ({render: sayRender, compare: sayComparison, bench: sayBench}[data.kind] || (() => ""))(data);
