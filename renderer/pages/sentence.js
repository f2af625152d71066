"use strict";
// Summarises a page in one sentence.

const countOfBlocks = n => n === 1 ? "1 block" : `${showCount(n)} blocks`;

function sayRender(data) {
  const t = data.totals, all = t.blocks, open = all - t.stoppedBlocks - t.blocksAtCap;
  const spp = data.images[0].blocks.map(b => b.spp), [least, most] = [Math.min(...spp), Math.max(...spp)];
  const each = (least === most ? showCount(least) : `${showCount(least)} to ${showCount(most)}`) + " samples per pixel";
  const start = `${t.interrupted ? "Interrupted after" : "Rendered in"} ${showSeconds(t.seconds)}: `;
  if (/^(fixed|thresholds)/.test(data.provenance.criterion)) return `${start}${each}, without a stopping rule.`;
  if (t.stoppedBlocks === all) return `${start}${all === 1 ? "its only block is" : `all ${showCount(all)} blocks are`} clean, at ${each}.`;
  return start + [`${showCount(t.stoppedBlocks)} of ${countOfBlocks(all)} ${t.stoppedBlocks === 1 ? "is" : "are"} clean`,
    t.blocksAtCap ? `${showCount(t.blocksAtCap)} at the cap of ${showCount(data.cap)} samples per pixel, still noisy` : "",
    open ? `${showCount(open)} not finished` + (t.timeUp ? " in time" : "") : ""].filter(s => s).join("; ") + ".";
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

function sayBench(data) {
  const rules = [...new Set(data.bench.points.map(p => p.rule))].filter(r => r !== "fixed");
  return (rules.length ? `${rules.join(", ")} compared with` : "Error of") + ` fixed sample counts: ${data.bench.points.length} points, against a reference of ${showCount(data.cap)}.`;
}

const saySentence = data => ({render: sayRender, compare: sayComparison, bench: sayBench}[data.kind] || (() => ""))(data);
