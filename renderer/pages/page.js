"use strict";
// Fills in the parts of a page that all reports have, with its data:
//   title, cap, width, height, notes [text], warnings {kind: count}, provenance {}
//   blocks [{x, y, width, height, end?, decisions? {threshold, spp [], value [], votes []},
//            curves? {spp [], entropy [], noise []}}], in pixels of the image, row by row
//   images [{name, label, rule, src, blocks [{spp, seconds, ruleSeconds, estimated}]}]
//   reference: the name of the image that the others are compared with, if any

const data = JSON.parse(byId("data").textContent);

// What a kind of page adds to them:
//   noun?: what it is, otherwise its kind
//   sppName(image), sppHead(image): names of sample counts, for overlays and columns
//   layers?, overlays? [{name, label, numbers}], overlay?: the first, isDivided?: of the viewer
//   summarise(): fills its summary
//   blockRows?(i, images, add, rows), blockColumns?(image, head, cells), lastColumns?(head, cells): of the tables of blocks
let page = {};

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

// `kind` is in words, `facts` and those of the sentence are texts.
function startPage(kind, sentence, facts, parts) {
  page = parts;
  const p = data.provenance;
  document.title = `${data.title} \u2013 lull ${kind}`;
  byId("title").textContent = data.title;
  byId("sentence").textContent = sentence;
  byId("subtitle").textContent = [`A ${parts.noun || kind} by lull` + (p ? " " + p.version : ""),
    `${data.width}\u00d7${data.height} pixels`, ...facts, data.cap ? `at most ${showCount(data.cap)} samples per pixel` : "",
    p ? `sampler ${[].concat(p.sampler).join(", ")}` : ""].filter(t => t).join(" \u00b7 ");
  document.body.classList.add(kind);
  startViewer(data);
  page.summarise();
  showBlocksTable(data);
  showProvenance(data);
  if (data.blocks.length && layers.length) chooseBlock(hardestBlock(data));
  dispatchEvent(new Event("resize"));  // now that the page has its height, and so its width
}
