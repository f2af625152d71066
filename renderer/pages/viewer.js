"use strict";
// Shows the images with the grid of blocks: one, two side by side, or two to swipe between.

const view = {a: 0, b: 1, mode: "one", overlay: "grid", zoom: 0, swipe: 0.5, block: 0};
let layers = [];  // pictures that can be shown: [{label, src, isMap}]
const stages = [];

function makeLayers(data) {
  for (const image of data.images) if (image.src) layers.push({label: image.label, src: image.src});
  for (const image of data.images)
    if (image.flipSrc) layers.push({label: "FLIP error of " + image.name, src: image.flipSrc, isMap: true});
}

// The numbers that an overlay colours: values, their places in [0, 1], colours and words for them.
function overlayNumbers(data) {
  if (view.overlay === "human") {
    // How much longer the rule went on than people asked for: colours by the ratio, a factor of
    // four at the ends.
    const [a, h] = ["automatic", "human"].map(name => data.images.find(i => i.name === name).blocks);
    return {values: a.map((b, i) => b.spp - h[i].spp), places: a.map((b, i) => 0.5 + Math.log2(b.spp / h[i].spp) / 4),
      colour: diverging, ink: () => "#000", ends: ["4 times earlier", "automatic against human: difference in samples per pixel", "4 times later"],
      show: v => (v > 0 ? "+" : v < 0 ? "\u2212" : "\u00b1") + Math.abs(v)};
  }
  const image = data.images.find(i => "spp:" + i.name === view.overlay);
  if (!image) return null;
  const values = image.blocks.map(b => b.spp);
  const low = (data.provenance && data.provenance.pass) || Math.min(...values);
  const high = Math.max(data.cap, ...values);
  const onScale = v => high > low ? Math.log(Math.max(v, low) / low) / Math.log(high / low) : 1;
  return {values, places: values.map(onScale), colour: viridis, ink: inkOn, show: String,
    ends: [showCount(low), `samples per pixel of ${image.name} (logarithmic)`, showCount(high)]};
}

function drawOverlay(data, svg) {
  svg.replaceChildren();
  const numbers = overlayNumbers(data);
  data.blocks.forEach((b, i) => {
    const place = {x: b.x, y: b.y, width: b.width, height: b.height};
    const facts = data.images.filter(m => m.blocks && m.blocks[i] && isNumber(m.blocks[i].spp))
      .map(m => `${m.name}: ${showCount(m.blocks[i].spp)} spp`).join("\n");
    const cell = make("rect", {...place, class: "cell", "data-block": i, click: () => chooseBlock(i),
      mouseenter: () => hover.setAttribute("visibility", "visible") || setPlace(hover, b),
      mouseleave: () => hover.setAttribute("visibility", "hidden")}, make("title", {}, `Block ${i}\n${facts}`));
    if (numbers) {
      const t = numbers.places[i];
      cell.setAttribute("style", `fill:${numbers.colour(t)}`);
      const size = Math.min(b.width / 4, b.height / 3, data.width / 18);
      svg.append(cell, make("text", {x: b.x + b.width / 2, y: b.y + b.height / 2, "font-size": size, fill: numbers.ink(t)},
        isNumber(numbers.values[i]) ? numbers.show(numbers.values[i]) : ""));
    } else svg.append(cell);
    if (view.overlay !== "none") svg.append(make("rect", {...place, class: "shadow"}), make("rect", {...place, class: "grid"}));
  });
  const hover = make("rect", {class: "hover", visibility: "hidden"});
  const mark = make("rect", {class: "mark"});
  if (data.blocks[view.block]) setPlace(mark, data.blocks[view.block]);
  svg.append(hover, mark);
}
function setPlace(rect, b) {
  for (const name of ["x", "y", "width", "height"]) rect.setAttribute(name, b[name]);
}

function moveWithKeys(data, event) {
  const from = data.blocks[view.block];
  const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
  if (!step || !from) return;
  event.preventDefault();
  const x = from.x + (step[0] < 0 ? -1 : step[0] > 0 ? from.width : 0);
  const y = from.y + (step[1] < 0 ? -1 : step[1] > 0 ? from.height : 0);
  const to = data.blocks.findIndex(b => x >= b.x && x < b.x + b.width && y >= b.y && y < b.y + b.height);
  if (to >= 0) chooseBlock(to);
}

function makeStage(data) {
  const stage = {images: [make("img", {alt: ""}), make("img", {alt: ""})],
    divider: make("div", {class: "divider"}), caption: make("figcaption"),
    svg: make("svg", {viewBox: `0 0 ${data.width} ${data.height}`, preserveAspectRatio: "none", tabindex: 0, role: "application",
      "aria-label": "Grid of blocks; arrow keys choose a block", keydown: e => moveWithKeys(data, e)})};
  stage.canvas = make("div", {class: "canvas"}, ...stage.images, stage.divider, stage.svg);
  stage.scroller = make("div", {class: "scroller"}, stage.canvas);
  // Two stages show the same part of their images.
  stage.scroller.addEventListener("scroll", () => stages.forEach(other => {
    if (other !== stage) { other.scroller.scrollLeft = stage.scroller.scrollLeft; other.scroller.scrollTop = stage.scroller.scrollTop; }
  }));
  stage.figure = make("figure", {class: "stage"}, stage.scroller, stage.caption);
  return stage;
}

function showStages(data) {
  const two = view.mode === "side", swipe = view.mode === "swipe";
  stages[1].figure.hidden = !two;
  byId("swipe-line").hidden = !swipe;
  stages.forEach((stage, s) => {
    if (s && !two) return;
    const lower = layers[s ? view.b : view.a], upper = swipe ? layers[view.b] : null;
    stage.images[0].src = lower.src;
    stage.images[0].alt = lower.label;
    stage.images[1].hidden = stage.divider.hidden = !upper;
    if (upper) {
      stage.images[1].src = upper.src;
      stage.images[1].alt = upper.label;
      stage.images[1].style.clipPath = `inset(0 0 0 ${100 * view.swipe}%)`;
      stage.divider.style.left = `calc(${100 * view.swipe}% - 1px)`;
    }
    stage.caption.textContent = upper ? `left: ${lower.label} \u00b7 right: ${upper.label}` : lower.label;
    const room = stage.scroller.clientWidth || 600;
    const width = view.zoom ? data.width * view.zoom : Math.min(room, Math.max(data.width, 900));
    stage.canvas.style.width = width + "px";
    stage.canvas.style.height = width * data.height / data.width + "px";
    stage.canvas.classList.toggle("large", width > 1.5 * data.width);
    drawOverlay(data, stage.svg);
  });
  showLegend(data);
}

function showLegend(data) {
  const legend = byId("legend");
  legend.replaceChildren();
  const numbers = overlayNumbers(data);
  const isMap = [view.a, view.mode === "one" ? view.a : view.b].some(i => layers[i].isMap);
  if (!numbers && !isMap) return;
  const colour = numbers ? numbers.colour : viridis;
  const stops = [...Array(17).keys()].map(i => colour(i / 16)).join(",");
  const ends = numbers ? numbers.ends : ["0", "FLIP: difference that people see", "1"];
  legend.append(make("div", {class: "bar", style: `background:linear-gradient(to right,${stops})`}),
    make("div", {class: "ends"}, ...ends.map(e => make("span", {}, e))));
}

function makeChoice(label, options, value, set) {
  const select = make("select", {"aria-label": label, change: () => set(select.value)},
    ...options.map(([v, text]) => make("option", {value: v, selected: String(v) === String(value)}, text)));
  return make("label", {}, label + " ", select);
}

function startViewer(data) {
  makeLayers(data);
  if (!layers.length) return;
  byId("viewer").hidden = false;
  if (layers.length === 1) view.b = 0;
  stages.push(makeStage(data), makeStage(data));
  byId("stages").append(...stages.map(s => s.figure));
  const update = () => { showStages(data); };
  const pictures = layers.map((l, i) => [i, l.label]);
  const overlays = [["grid", "grid"], ["none", "nothing"],
    ...data.images.filter(i => i.blocks && i.blocks.some(b => isNumber(b.spp))).map(i => ["spp:" + i.name, "spp of " + i.name]),
    ...(data.againstHuman ? [["human", "difference to human"]] : [])];
  const second = makeChoice("and", pictures, view.b, v => { view.b = +v; update(); });
  const showSecond = () => { second.hidden = view.mode === "one"; };
  byId("controls").append(
    layers.length > 1 ? makeChoice("Show", [["one", "one image"], ["swipe", "two, to swipe"], ["side", "two, side by side"]], view.mode,
      v => { view.mode = v; showSecond(); update(); }) : "",
    makeChoice("Image", pictures, view.a, v => { view.a = +v; update(); }), second,
    data.blocks.length ? makeChoice("Over it", overlays, view.overlay, v => { view.overlay = v; update(); }) : "",
    makeChoice("Zoom", [[0, "fit"], [0.5, "50 %"], [1, "100 %"], [2, "200 %"], [4, "400 %"], [8, "800 %"]], 0, v => { view.zoom = +v; update(); }));
  showSecond();
  byId("swipe").addEventListener("input", e => { view.swipe = e.target.value / 100; update(); });
  addEventListener("resize", update);
  update();
}
