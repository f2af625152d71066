"use strict";
// Fills the page with the data of a render, a comparison or a bench:
//   kind, title, cap, width, height, notes [text], warnings {kind: count}, provenance {}
//   blocks [{x, y, width, height, end?, decisions? {threshold, spp [], value [], votes []},
//            curves? {spp [], entropy [], noise []}}], in pixels of the image, row by row
//   images [{name, label, rule, src, flipSrc?, visibleDifferenceSrc?, visibleBlocks?, figures?, seams?, cost?,
//            saved?,          blocks [{spp, seconds, ruleSeconds, estimated, and figures}]}]
//   viewing {name, pixelsPerDegree, threshold}: for visible differences, with the visibility threshold
//   reference: the name of the image that the others are compared with
//   totals (render); againstHuman, estimates, verifications (compare)
//   bench {samplers [], points [{rule, setting, sampler, spp, seconds, sharesReference, and
//   figures}]}

const data = JSON.parse(byId("data").textContent);

function chooseBlock(i) {
  view.block = i;
  showBlock(data, i);
  stages.forEach(s => drawOverlay(data, s.svg));
  [...byId("blocks-table").querySelectorAll("tbody tr")].forEach((row, k) => row.classList.toggle("chosen", k === i));
}

// Returns the block that took the most samples: there is most to see.
function hardestBlock(data) {
  const spp = data.blocks.map((b, i) => Math.max(...data.images.filter(m => m.name !== data.reference && m.blocks && m.blocks[i]).map(m => m.blocks[i].spp || 0)));
  return Math.max(0, spp.indexOf(Math.max(...spp)));
}

document.title = `${data.title} \u2013 lull ${data.kind}`;
byId("title").textContent = data.title;
const p = data.provenance;
byId("sentence").textContent = saySentence(data);
byId("subtitle").textContent = [{render: "A render", compare: "A comparison", bench: "A bench"}[data.kind] + " by lull" + (p ? " " + p.version : ""),
  `${data.width}\u00d7${data.height} pixels`, data.kind === "render" ? `stops by ${p.criterion}` : "", data.cap ? `at most ${showCount(data.cap)} samples per pixel` : "",
  p ? `sampler ${[].concat(p.sampler).join(", ")}` : ""].filter(t => t).join(" \u00b7 ");
document.body.classList.add(data.kind);
startBench(data);
startViewer(data);
showTotals(data);
showSummary(data);
showBlocksTable(data);
showProvenance(data);
if (data.blocks.length && layers.length) chooseBlock(hardestBlock(data));
dispatchEvent(new Event("resize"));  // now that the page has its height, and so its width
