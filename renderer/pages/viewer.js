"use strict";
// Shows the images with the grid of blocks: one; two that take turns, that a divider parts, or that
// are side by side; of a pair for two eyes, both eyes' in turn.

const view = {a: 0, b: 1, mode: "one", overlay: "grid", zoom: 0, divide: 0.5, block: 0};
let layers = [];  // pictures that can be shown: [{label, src, ends?}], with the ends of a map's scale
const stages = [];
let flickering = 0;  // the timer of pictures that take turns

// How long each of two pictures is shown. Noise is seen best where it appears and vanishes; three
// flashes a second and more would be a danger to some.
const flickerMs = 500;

// The numbers that an overlay colours: values, their places in [0, 1], colours and words for them.
function overlayNumbers(data) {
  const own = (page.overlays || []).find(o => o.name === view.overlay);
  if (own) return own.numbers;
  const image = data.images.find(i => "spp:" + i.name === view.overlay);
  if (!image) return null;
  const values = image.blocks.map(b => b.spp);
  const low = (data.provenance && data.provenance.pass) || Math.min(...values);
  const high = Math.max(data.cap, ...values);
  const onScale = v => high > low ? Math.log(Math.max(v, low) / low) / Math.log(high / low) : 1;
  return {values, places: values.map(onScale), colour: viridis, show: showCount,
    ends: [showCount(low), `${page.sppName(image)} (logarithmic)`, showCount(high)]};
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
      const size = Math.min(b.width / 5, b.height / 4, data.width / 30);
      svg.append(cell, make("text", {x: b.x + b.width / 2, y: b.y + b.height / 2, "font-size": size},
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
  const to = blockByKey(data.blocks, data.blocks[view.block], event);
  if (to !== null && to >= 0) chooseBlock(to);
}

// Sets the place of the divider, a share of the width.
function divideAt(share) {
  view.divide = Math.min(1, Math.max(0, share));
  for (const stage of stages) {
    stage.images[1].style.clipPath = view.mode === "divide" ? `inset(0 0 0 ${100 * view.divide}%)` : "";
    stage.divider.style.left = 100 * view.divide + "%";
    stage.divider.setAttribute("aria-valuenow", Math.round(100 * view.divide));
  }
}

function makeDivider(canvas) {
  const divider = make("div", {class: "divider", role: "slider", tabindex: 0, "aria-label": "Divider between both images",
    "aria-valuemin": 0, "aria-valuemax": 100,
    pointerdown: e => { e.preventDefault(); divider.focus(); divider.setPointerCapture(e.pointerId); },
    pointermove: e => {
      if (!divider.hasPointerCapture(e.pointerId)) return;
      const place = canvas.getBoundingClientRect();
      divideAt((e.clientX - place.left) / place.width);
    },
    keydown: e => {
      const step = {ArrowLeft: -0.02, ArrowRight: 0.02}[e.key];
      if (step) { e.preventDefault(); divideAt(view.divide + step); }
    }});
  return divider;
}

function makeStage(data) {
  const stage = {images: [make("img", {alt: ""}), make("img", {alt: ""})], caption: make("figcaption"), canvas: make("div", {class: "canvas"}),
    svg: make("svg", {viewBox: `0 0 ${data.width} ${data.height}`, preserveAspectRatio: "none", tabindex: 0, role: "application",
      "aria-label": "Grid of blocks; arrow keys choose a block", keydown: e => moveWithKeys(data, e)})};
  stage.divider = makeDivider(stage.canvas);
  stage.canvas.append(...stage.images, stage.svg, stage.divider);
  stage.scroller = make("div", {class: "scroller"}, stage.canvas);
  // Two stages show the same part of their images.
  stage.scroller.addEventListener("scroll", () => stages.forEach(other => {
    if (other !== stage) { other.scroller.scrollLeft = stage.scroller.scrollLeft; other.scroller.scrollTop = stage.scroller.scrollTop; }
  }));
  stage.figure = make("figure", {class: "stage"}, stage.scroller, stage.caption);
  return stage;
}

// Returns how wide an image is shown: as its zoom says, or as large as the window has room for.
function shownWidth(width, height, room) {
  if (view.zoom) return width * view.zoom;
  return Math.min(room, Math.max(320, 0.85 * innerHeight * width / height));
}

function showStages(data) {
  const two = view.mode === "side", eyes = view.mode === "eyes", over = view.mode === "divide" || view.mode === "flicker";
  const pixels = eyes ? data.eyeWidth : data.width;
  stages[1].figure.hidden = !two;
  stages.forEach((stage, s) => {
    if (s && !two) return;
    const lower = layers[s ? view.b : view.a], upper = over ? layers[view.b] : eyes ? lower : null;
    stage.images[0].src = lower.src;
    stage.images[0].alt = lower.label;
    stage.images[1].hidden = !upper;
    stage.divider.hidden = view.mode !== "divide";
    if (upper) {
      stage.images[1].src = upper.src;
      stage.images[1].alt = upper.label;
    }
    stage.caption.textContent = view.mode === "divide" ? `left: ${lower.label} \u00b7 right: ${upper.label}` : lower.label;
    const width = shownWidth(pixels, data.height, stage.scroller.clientWidth || 600);
    stage.canvas.style.width = width + "px";
    stage.canvas.style.height = width * data.height / pixels + "px";
    stage.canvas.classList.toggle("large", width > 1.5 * pixels);
    stage.canvas.classList.toggle("eyes", eyes);
    stage.svg.setAttribute("viewBox", `0 0 ${pixels} ${data.height}`);
    drawOverlay(data, stage.svg);
  });
  divideAt(view.divide);
  takeTurns();
  showLegend(data);
}

// Lets both images take turns while that is how they are shown; by the button alone once it is
// pressed, and for those who want less motion.
function takeTurns() {
  clearInterval(flickering);
  const button = byId("turn"), names = {flicker: [view.a, view.b].map(i => layers[i].label), eyes: ["left eye", "right eye"]}[view.mode];
  button.hidden = !names;
  if (!names) return;
  const [stage] = stages;
  const turn = () => {
    stage.images[1].hidden = !stage.images[1].hidden;
    stage.caption.textContent = names[stage.images[1].hidden ? 0 : 1];
  };
  turn();
  button.onclick = () => { clearInterval(flickering); turn(); };
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) flickering = setInterval(turn, flickerMs);
}

function showLegend(data) {
  const legend = byId("legend");
  legend.replaceChildren();
  const numbers = overlayNumbers(data);
  const map = [view.a, view.mode === "one" ? view.a : view.b].map(i => layers[i]).find(l => l.ends);
  if (!numbers && !map) return;
  legend.append(...makeScale(numbers ? numbers.colour : viridis, (numbers || map).ends));
}

function startViewer(data) {
  for (const image of data.images) if (image.src) layers.push({label: image.label, src: image.src});
  layers.push(...(page.layers || []));
  if (!layers.length) return;
  byId("viewer").hidden = false;
  if (layers.length === 1) view.b = 0;
  stages.push(makeStage(data), makeStage(data));
  byId("stages").append(...stages.map(s => s.figure));
  const update = () => { showStages(data); };
  const pictures = layers.map((l, i) => [i, l.label]);
  const overlays = [["grid", "grid"], ["none", "nothing"],
    ...data.images.filter(i => i.blocks && i.blocks.some(b => isNumber(b.spp))).map(i => ["spp:" + i.name, page.sppName(i)]),
    ...(page.overlays || []).map(o => [o.name, o.label])];
  if (page.overlay) view.overlay = page.overlay;
  if (data.width <= stages[0].scroller.clientWidth) view.zoom = 1;  // as observers judged; scaled up, a clean block shows grain
  if (page.isDivided && layers.length > 1) {
    view.mode = "divide";
    view.b = data.images.filter(i => i.src).length - 1;
  }
  const second = makeChoice("and", pictures, view.b, v => { view.b = +v; update(); });
  const over = makeChoice("Overlay", overlays, view.overlay, v => { view.overlay = v; update(); });
  const showSecond = () => { second.hidden = view.mode === "one" || view.mode === "eyes"; };
  const modes = [["one", "one image"], ...(data.eyeWidth ? [["eyes", "both eyes, flickering"]] : []),
    ...(layers.length > 1 ? [["flicker", "two, flickering"], ["divide", "two, with a divider"], ["side", "two, side by side"]] : [])];
  const setMode = mode => {
    view.mode = mode;
    if (mode === "flicker" || mode === "eyes") over.querySelector("select").value = view.overlay = "none";  // it would hide the noise
    showSecond();
    update();
  };
  byId("controls").append(
    modes.length > 1 ? makeChoice("Show", modes, view.mode, setMode) : "", make("button", {id: "turn", type: "button", hidden: ""}, "Switch"),
    makeChoice("Image", pictures, view.a, v => { view.a = +v; update(); }), second,
    data.blocks.length ? over : "",
    makeChoice("Zoom", [[0, "fit"], [0.5, "50 %"], [1, "100 %"], [2, "200 %"], [4, "400 %"], [8, "800 %"]], view.zoom, v => { view.zoom = +v; update(); }));
  showSecond();
  addEventListener("resize", update);
  update();
}
