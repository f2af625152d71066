"use strict";
// Small helpers: numbers for people, elements, colours.

const isNumber = v => typeof v === "number" && isFinite(v);

// Formats with about `digits` significant digits; "-" for unknown values.
function show(v, digits = 4) {
  if (!isNumber(v)) return "\u2013";
  if (v === 0 || (Math.abs(v) >= 1e-3 && Math.abs(v) < 1e6)) return String(+v.toPrecision(digits));
  return v.toExponential(digits - 1);
}
const showCount = v => isNumber(v) ? Math.round(v).toLocaleString("en") : "\u2013";
const showShare = v => isNumber(v) ? (100 * v).toFixed(1) + "\u00a0%" : "\u2013";
function showSeconds(v) {
  if (!isNumber(v)) return "\u2013";
  if (v > 0 && v < 1e-3) return "<\u00a01\u00a0ms";
  if (v < 120) return show(v, 3) + "\u00a0s";
  const minutes = Math.floor(v / 60);
  const two = n => String(Math.floor(n)).padStart(2, "0");
  return minutes < 60 ? minutes + ":" + two(v % 60) + "\u00a0min"
                      : Math.floor(minutes / 60) + ":" + two(minutes % 60) + ":" + two(v % 60) + "\u00a0h";
}

// Returns a stopping rule in words: given as its name, after ":" its argument, after ", " its caution.
function ruleLabel(text) {
  const [, name, argument, rest] = /^([^:,]*):?(.*?)((?:, caution .*)?)$/s.exec(text || "");
  const label = {
    learned: argument ? `model ${argument}` : "default rule", entropy: `visible noise below ${argument} L*`,
    lnoise: `masked noise below ${argument} L*`, denoised: `visible difference of the denoised image below ${argument}`,
    fixed: `${argument} samples per pixel`, thresholds: `sample counts of ${argument}`}[name];
  return (label || (argument ? `${name}, ${argument}` : name)) + rest;
}

const byId = id => document.getElementById(id);

// Makes an element; attributes that are functions listen to events.
function make(tag, attributes = {}, ...children) {
  const svg = ["svg", "rect", "text", "g", "title", "path"].includes(tag);
  const element = svg ? document.createElementNS("http://www.w3.org/2000/svg", tag)
                      : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    if (typeof value === "function") element.addEventListener(name, value);
    else if (value !== false && value != null) element.setAttribute(name, value === true ? "" : value);
  element.append(...children.filter(c => c != null));
  return element;
}

// Makes a table of rows of texts.
function makeTable(caption, head, rows) {
  return make("table", {}, caption ? make("caption", {}, caption) : null,
    head ? make("thead", {}, make("tr", {}, ...head.map(h => make("th", {scope: "col"}, h)))) : null,
    make("tbody", {}, ...rows.map(row => make("tr", {}, ...row.map((cell, i) =>
      make(i ? "td" : "th", i ? {} : {scope: "row"}, cell))))));
}

function makeChoice(label, options, value, set) {
  const select = make("select", {"aria-label": label, change: () => set(select.value)},
    ...options.map(([v, text]) => make("option", {value: v, selected: String(v) === String(value)}, text)));
  return make("label", {}, label + " ", select);
}

function saveText(name, type, text) {
  const url = URL.createObjectURL(new Blob([text], {type}));
  make("a", {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

// Returns the number of the block that an arrow key leads to from one of `blocks`; null for other keys, -1 at the border.
function blockByKey(blocks, from, event) {
  const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
  if (!step || !from) return null;
  event.preventDefault();
  const x = from.x + (step[0] < 0 ? -1 : step[0] > 0 ? from.width : 0);
  const y = from.y + (step[1] < 0 ? -1 : step[1] > 0 ? from.height : 0);
  return blocks.findIndex(b => x >= b.x && x < b.x + b.width && y >= b.y && y < b.y + b.height);
}

// Returns the scale of a colour map, with the texts at its ends.
function makeScale(colour, ends) {
  const stops = [...Array(17).keys()].map(i => colour(i / 16)).join(",");
  return [make("div", {class: "bar", style: `background:linear-gradient(to right,${stops})`}),
    make("div", {class: "ends"}, ...ends.map(e => make("span", {}, e)))];
}

// Viridis: ordered by lightness for every kind of colour vision.
const viridisTable = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141],
                      [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
function viridis(t) {
  const x = Math.min(1, Math.max(0, t)) * 8, i = Math.min(7, Math.floor(x));
  const c = viridisTable[i].map((v, k) => Math.round(v + (x - i) * (viridisTable[i + 1][k] - v)));
  return `rgb(${c.join(",")})`;
}
// Blue by white to orange, for values with a sign.
function diverging(t) {
  const x = Math.min(1, Math.max(0, t)) * 2 - 1, end = x < 0 ? [58, 134, 200] : [224, 130, 40];
  return `rgb(${end.map(v => Math.round(247 + Math.abs(x) * (v - 247))).join(",")})`;
}

// Okabe and Ito's colours, which everyone can tell apart; together with dashes and marks. Their black
// is left to what is drawn in the colour of text, which the browser chooses light or dark.
const palette = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f"];
const themeColour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
