"use strict";
// Fills in the parts of a page that all reports have, with its data:
//   title, cap, width, height, eyeWidth?, notes [text], warnings {kind: count}, provenance {}
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

// The figures and curves of a block, and the tables.

const blockEnds = {clean: "clean", cap: "at the cap, still noisy", interrupted: "interrupted", time: "out of time"};

// What the value of a rule is: the title of its chart and the label of its axis.
const ruleValues = {learned: ["Probability that an observer sees noise", "probability"], entropy: ["Visible noise, L*", "noise, L*"],
  lnoise: ["Masked noise, L*", "noise, L*"], denoised: ["Visible difference of the denoised block, estimate", "difference"]};

// Says what the last checks of a block decided. Rules that vote count the checks in a row below the threshold.
function sayDecision(decisions) {
  const votes = decisions.votes.at(-1), below = `below ${show(decisions.threshold, 3)}`;
  if (decisions.value.at(-1) >= decisions.threshold) return `At the last check not ${below}.`;
  return votes > 1 ? `${votes} checks in a row ${below}.` : `At the last check ${below}.`;
}

function drawDecisions(parent, block, rule, lines) {
  const d = block.decisions, name = rule.split(/[:,]/)[0], isLearned = name === "learned";
  const [title, yLabel] = ruleValues[name] || [`Value of the stopping rule: ${ruleLabel(rule)}`, "value"];
  const votes = Math.max(d.votes.at(-1), d.value.at(-1) < d.threshold ? 1 : 0), last = a => votes ? a.slice(-votes) : [];
  drawChart(parent, [
    {label: isLearned ? "probability" : "value", x: d.spp, y: d.value, colour: palette[0], mark: 0},
    {label: "threshold", x: d.spp, y: d.spp.map(() => d.threshold), dash: [2, 4]},
    ...(votes ? [{label: "votes to stop", x: last(d.spp), y: last(d.value), colour: palette[1], mark: 3, line: false,
      texts: last(d.spp).map((_, i) => String(i + 1))}] : [])
  ], {title, note: sayDecision(d) + (block.end === "clean" ? " The block is clean." : ""),
      xLabel: "samples per pixel", yLabel, logY: !isLearned, yRange: isLearned ? [0, 1] : null, lines});
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
  if (page.blockRows) page.blockRows(i, images, add, rows);
  if (block.end) rows.push(["end", blockEnds[block.end]]);
  if (isNumber(block.maskedNoise)) rows.push(["masked noise, L*", block.maskedNoise.toFixed(2)]);
  const error = block.visibleDifference;
  if (error) rows.push(["visible difference, denoised", `${error.estimate.toFixed(1)}, upper bound ${error.upper.toFixed(1)}`]);
  if (error && error.worstPixels) rows.push(["excluded pixels", `${showCount(error.worstPixels)}, error up to ${error.worst.toFixed(0)} L*`]);
  if (block.end === "cap" && isNumber(block.neededSpp)) rows.push(["estimated stop", `${showCount(block.neededSpp)} spp`]);
  if (isNumber(block.neededSeconds)) rows.push(["missing CPU time (estimate)", `~${showSeconds(block.neededSeconds)}`]);
  byId("block-facts").replaceChildren(makeTable("", images.length > 1 ? ["", ...images.map(m => m.name)] : null, rows));

  const lines = data.images.filter(m => m.blocks && m.blocks[i] && m.name !== data.reference && isNumber(m.blocks[i].spp))
    .map((m, k) => ({x: m.blocks[i].spp, label: m.name === "image" ? `${blockEnds[block.end].split(",")[0]}: ${showCount(m.blocks[i].spp)} spp` : m.name,
      colour: palette[k === 0 ? 1 : 2]}));
  const parent = byId("block-charts");
  parent.replaceChildren();
  const rule = (data.provenance || {}).criterion || "";
  if (block.decisions && !/^(fixed|thresholds)/.test(rule)) drawDecisions(parent, block, rule, lines);  // those only count
  if (block.curves && block.curves.spp.length) {
    const c = block.curves;
    drawChart(parent, [{label: "noise", x: c.spp, y: c.noise, colour: palette[1], mark: 1}],
      {title: "Masked noise, L*", xLabel: "samples per pixel", yLabel: "noise, L*", logY: true, lines});
    const low = Math.min(...c.entropy), high = Math.max(...c.entropy), room = Math.max(0.002, 0.1 * (high - low));
    drawChart(parent, [{label: "entropy", x: c.spp, y: c.entropy, colour: palette[2], mark: 2}],
      {title: "SVD-entropy, mean of 100 sub-blocks", xLabel: "samples per pixel", yLabel: "entropy", yRange: [low - room, high + room], lines});
  }
  byId("curves").hidden = !parent.children.length;
}

function showBlocksTable(data) {
  const images = data.images.filter(i => i.blocks && i.blocks.length && i.name !== data.reference);
  if (!data.blocks.length || !images.length) return;
  byId("blocks").hidden = false;
  const head = ["block"], cells = [];
  for (const image of images) {
    head.push(page.sppHead(image));
    cells.push(i => showCount(image.blocks[i].spp));
    if (image.blocks[0].seconds > 0) { head.push("CPU time, s"); cells.push(i => (image.blocks[i].estimated ? "~" : "") + show(image.blocks[i].seconds, 3)); }
    if (page.blockColumns) page.blockColumns(image, head, cells);
  }
  if (page.lastColumns) page.lastColumns(head, cells);
  if (data.blocks[0].end) { head.push("end"); cells.push(i => blockEnds[data.blocks[i].end].split(",")[0]); }
  const table = makeTable("", head, data.blocks.map((b, i) => [String(i), ...cells.map(c => c(i))]));
  [...table.tBodies[0].rows].forEach((row, i) => row.addEventListener("click", () => chooseBlock(i)));
  byId("blocks-table").append(withCsv(table, "blocks"));
}

// Returns a key of the provenance in words.
const provenanceLabel = key => ({criterion: "stopping rule", cap: "cap, spp", pass: "pass, spp", blockSize: "block size, pixels",
  judgedGrades: "graded by, stops", clock: "time limit"}[key] || key.replace(/[A-Z]/g, c => " " + c.toLowerCase()));

function showProvenance(data) {
  byId("notes").append(...(data.notes || []).map(n => make("li", {}, n)),
    ...Object.entries(data.warnings || {}).map(([kind, count]) => make("li", {}, `Warning, ${count} times: ${kind}`)));
  const rows = Object.entries(data.provenance || {}).filter(([, v]) => v !== "").map(([k, v]) =>
    [provenanceLabel(k), k === "criterion" ? [].concat(v).map(ruleLabel).join(", ") : v && typeof v === "object" ? Object.entries(v).map(([a, b]) => Array.isArray(v) ? b : `${a} ${b}`).join(", ") : String(v)]);
  if (rows.length) byId("provenance-table").replaceChildren(makeTable("", null, rows).querySelector("tbody"));
  byId("provenance").hidden = !rows.length && !byId("notes").children.length;
}
