"use strict";
// Draws charts of curves over a logarithmic axis with uPlot, and saves them as SVG; saves charts and tables as CSV.

// Returns the path, as of SVG, of a mark that can be told apart without colour; the last kind is stroked, the others are filled.
function markPath(kind, x, y, s) {
  return [`M${x - s} ${y}a${s} ${s} 0 1 0 ${2 * s} 0a${s} ${s} 0 1 0 ${-2 * s} 0z`,
    `M${x - s} ${y - s}h${2 * s}v${2 * s}h${-2 * s}z`,
    `M${x} ${y - 1.3 * s}l${1.2 * s} ${2.3 * s}h${-2.4 * s}z`,
    `M${x} ${y - 1.4 * s}l${1.4 * s} ${1.4 * s}l${-1.4 * s} ${1.4 * s}l${-1.4 * s} ${-1.4 * s}z`,
    `M${x - s} ${y - s}l${2 * s} ${2 * s}m${-2 * s} 0l${2 * s} ${-2 * s}`][kind];
}

// The same marks as characters, for legends.
const markCharacters = "\u25cf\u25a0\u25b2\u25c6\u2715";

// Joins series that have their own x into the one table that uPlot wants.
function joinSeries(series) {
  const xs = [...new Set(series.flatMap(s => s.x))].sort((a, b) => a - b);
  const place = new Map(xs.map((x, i) => [x, i]));
  return [xs, ...series.map(s => {
    const column = new Array(xs.length).fill(undefined);
    s.x.forEach((x, i) => { if (isNumber(s.y[i]) && !(s.log && s.y[i] <= 0)) column[place.get(x)] = s.y[i]; });
    return column;
  })];
}

// Returns the texts of a series' marks, above them, as [x, y, text].
const markTexts = s => (s.texts || []).map((text, i) => [s.x[i], s.y[i], text]);
const textRise = 11;  // px from the middle of a mark

const lineRow = 15;  // px that the label of a line takes

// Marks places on the x axis: [{x, label, colour}], with their labels above the plot, below each other.
function drawLines(u, lines) {
  const c = u.ctx, ratio = devicePixelRatio;
  c.save();
  c.font = `${12 * ratio}px sans-serif`;
  lines.forEach((l, i) => {
    const x = u.valToPos(l.x, "x", true), top = u.bbox.top - (lines.length - i) * lineRow * ratio;
    if (x < u.bbox.left - 1 || x > u.bbox.left + u.bbox.width + 1) return;
    c.strokeStyle = c.fillStyle = l.colour;
    c.lineWidth = 1.5 * ratio;
    c.setLineDash([6 * ratio, 4 * ratio]);
    c.beginPath(); c.moveTo(x, top); c.lineTo(x, u.bbox.top + u.bbox.height); c.stroke();
    const right = x > u.bbox.left + 0.6 * u.bbox.width;
    c.textAlign = right ? "right" : "left";
    c.fillText(l.label, x + (right ? -4 : 4) * ratio, top + 11 * ratio);
  });
  c.restore();
}

// Returns the places of ticks on a logarithmic axis: as many of each power of ten as there is room
// for.
function logTicks(min, max) {
  const ticks = digits => {
    const found = [];
    for (let e = Math.floor(Math.log10(min)); e <= Math.ceil(Math.log10(max)); ++e)
      for (const d of digits) { const v = +(d + "e" + e); if (v >= min * 0.9999 && v <= max * 1.0001) found.push(v); }
    return found;
  };
  for (const digits of [[1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 9], [1, 2, 3, 4, 5, 6, 7, 8, 9], [1, 2, 3, 5, 7], [1, 2, 5], [1, 3]])
    if (ticks(digits).length <= 7) return ticks(digits);
  return ticks([1]);
}

const charts = [];  // [chart, element], to follow the width of the page

// Draws series [{label, x, y, colour?, dash, mark, line, texts?}], without a colour in that of text, into `parent`. options: title,
// xLabel, yLabel, logY, lines, height, endsVary (curves that end at different places), note (a sentence below the title).
function drawChart(parent, series, options) {
  const box = make("div", {class: "chart"}, make("h3", {}, options.title), options.note ? make("p", {class: "note"}, options.note) : null);
  parent.append(box);
  // A curve that is 0 throughout is one as well.
  const isLogY = options.logY && series.some(s => (s.mark != null || s.line) && s.y.some(v => v > 0));
  const logs = series.map(s => ({...s, log: isLogY}));
  const data = joinSeries(logs);
  if (!data[0].length) { box.append(make("p", {class: "small"}, "No data.")); return null; }
  // A logarithmic axis needs two different ends.
  const widen = (min, max) => min === max ? [min / 1.5, max * 1.5] : [min / 1.08, max * 1.08];
  const number = v => show(v, 3), lines = (options.lines || []).filter(l => isNumber(l.x));
  // Until somebody points at the chart, its legend has the last value of each curve, if that is where
  // all of them end.
  const inLegend = (u, v, s, i) => isNumber(v) ? number(v) : i != null ? "\u2013" : options.endsVary ? "" : number(u.data[s].findLast(isNumber));
  const axis = (label, size, isLog) => ({...(isLog ? {splits: (u, i, min, max) => logTicks(min, max), filter: (u, splits) => splits} : {}),
    label, size, labelSize: 20, font: "12px sans-serif", labelFont: "12px sans-serif",
    stroke: () => themeColour("--soft"), grid: {stroke: () => themeColour("--faint")}, ticks: {stroke: () => themeColour("--faint")}, values: (u, splits) => splits.map(v => v == null ? "" : number(v))});
  const plot = new uPlot({
    width: Math.max(240, box.clientWidth || 420), height: (options.height || 240) + lines.length * lineRow,
    padding: [8 + lines.length * lineRow, 12, 0, 0], cursor: {points: {size: 7}}, legend: {live: true},
    scales: {
      x: {time: false, distr: 3, range: (u, min, max) => widen(min, max)},
      y: isLogY ? {distr: 3, range: (u, min, max) => widen(min, max)} : {range: (u, min, max) => {
        const low = options.yRange ? options.yRange[0] : Math.min(0, min), high = options.yRange ? options.yRange[1] : max;
        return low === high ? [low, low + 1] : [low, high + 0.05 * (high - low)]; }}
    },
    axes: [axis(options.xLabel, 34, true), axis(options.yLabel, 58, isLogY)],
    series: [{label: options.xLabel, value: inLegend},
      ...series.map(s => ({
        label: s.mark == null ? s.label : `${markCharacters[s.mark]} ${s.label}`, stroke: () => s.colour || themeColour("--ink"), width: s.line === false ? 0 : 2, dash: s.dash, spanGaps: true,
        value: inLegend,
        points: s.mark == null ? {show: false} : {show: (u, i) => {
          const c = u.ctx, [xs, ys] = [u.data[0], u.data[i]];
          c.save(); c.fillStyle = c.strokeStyle = s.colour || themeColour("--ink"); c.lineWidth = 2 * devicePixelRatio;
          const path = new Path2D(xs.map((x, k) => isNumber(ys[k]) ? markPath(s.mark, u.valToPos(x, "x", true), u.valToPos(ys[k], "y", true), 3.5 * devicePixelRatio) : "").join(""));
          s.mark < 4 ? c.fill(path) : c.stroke(path);
          c.font = `600 ${12 * devicePixelRatio}px sans-serif`;
          c.textAlign = "center";
          for (const [x, y, text] of markTexts(s)) c.fillText(text, u.valToPos(x, "x", true), u.valToPos(y, "y", true) - textRise * devicePixelRatio);
          c.restore();
          return false; }}
      }))],
    hooks: {draw: [u => drawLines(u, lines)]}
  }, data, box);
  box.firstChild.append(saveButton("SVG", options.title, () => saveText(fileName(options.title, ".svg"), "image/svg+xml", chartSvg(plot, series, options))),
    saveButton("CSV", options.title, () => saveText(fileName(options.title, ".csv"), "text/csv", chartCsv(series, options.xLabel, data))));
  charts.push([plot, box]);
  return plot;
}

function fitCharts() {
  for (const [plot, box] of charts)
    if (box.isConnected && box.clientWidth > 0) plot.setSize({width: box.clientWidth, height: plot.height});
}
addEventListener("resize", fitCharts);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => charts.forEach(([plot]) => plot.redraw()));

// Names a file after the page and a title.
const fileName = (title, extension) =>
  (document.title.split(" \u2013 ")[0] + "-" + title).replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-+|-+$/g, "") + extension;

const csvField = v => { const text = String(v ?? ""); return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text; };
const csvOf = rows => rows.map(row => row.map(csvField).join(",") + "\n").join("");

const saveButton = (label, what, save) => make("button", {class: "save", "aria-label": `Save ${what} as ${label}`, title: `Save as ${label}`, click: save}, label);

// A column for the x axis, and one for each curve.
const chartCsv = (series, xLabel, [xs, ...ys]) =>
  csvOf([[xLabel, ...series.map(s => s.label)], ...xs.map((x, i) => [x, ...ys.map(y => y[i])])]);

// Adds a button that saves a table as it stands, with numbers as programs read them.
function withCsv(table, title) {
  const cells = row => [...row.cells].map(c => {
    const text = c.textContent;
    return /^\d{1,3}(,\d{3})+$/.test(text) ? text.replaceAll(",", "") : text === "\u2013" ? "" : text.replaceAll("\u00a0", " ").replaceAll("\u200b", "");
  });
  return make("div", {}, saveButton("CSV", title, () => saveText(fileName(title, ".csv"), "text/csv", csvOf([...table.rows].map(cells)))), table);
}

const svgMark = (kind, x, y, colour) =>
  make("path", {d: markPath(kind, x, y, 3.5), ...(kind < 4 ? {fill: colour} : {fill: "none", stroke: colour, "stroke-width": 2})});

// Draws a chart as an SVG with a white background: as on the page at the time, with its legend below.
function chartSvg(plot, series, options) {
  const ink = "#1a1a1a", soft = "#595959", faint = "#d9d9d9", ratio = devicePixelRatio, row = 18, top = 24;
  const left = plot.bbox.left / ratio, width = plot.bbox.width / ratio, upper = top + plot.bbox.top / ratio, height = plot.bbox.height / ratio;
  const placeX = v => +(left + plot.valToPos(v, "x")).toFixed(2), placeY = v => +(upper + plot.valToPos(v, "y")).toFixed(2);
  const legendTop = top + plot.height + 8;
  const svg = make("svg", {width: plot.width, height: legendTop + row * series.length + 8, viewBox: `0 0 ${plot.width} ${legendTop + row * series.length + 8}`,
    "font-family": "sans-serif", "font-size": 12});
  const text = (x, y, label, anchor, colour, more = {}) => svg.append(make("text", {x, y, "text-anchor": anchor, fill: colour, ...more}, label));
  svg.append(make("rect", {width: "100%", height: "100%", fill: "#fff"}));
  text(left, 16, options.title, "start", ink, {"font-weight": 600});
  const ticks = axis => plot.axes[axis]._splits.filter(v => v != null);
  for (const v of ticks(0)) {
    svg.append(make("path", {d: `M${placeX(v)} ${upper}v${height}`, stroke: faint}));
    text(placeX(v), upper + height + 16, show(v, 3), "middle", soft);
  }
  for (const v of ticks(1)) {
    svg.append(make("path", {d: `M${left} ${placeY(v)}h${width}`, stroke: faint}));
    text(left - 6, placeY(v) + 4, show(v, 3), "end", soft);
  }
  text(left + width / 2, upper + height + 36, options.xLabel, "middle", soft);
  text(0, 0, options.yLabel, "middle", soft, {transform: `translate(14 ${upper + height / 2}) rotate(-90)`});
  const [xs, ...ys] = plot.data;
  series.forEach((s, i) => {
    const colour = s.colour || ink, points = xs.map((x, k) => [x, ys[i][k]]).filter(p => isNumber(p[1])).map(p => [placeX(p[0]), placeY(p[1])]);
    const line = {fill: "none", stroke: colour, "stroke-width": 2, "stroke-dasharray": s.dash ? s.dash.join(" ") : null};
    const y = legendTop + row * (i + 0.5);
    if (s.line !== false) svg.append(make("path", {d: points.map((p, k) => (k ? "L" : "M") + p.join(" ")).join(""), ...line}), make("path", {d: `M${left} ${y}h24`, ...line}));
    if (s.mark != null) svg.append(...points.map(p => svgMark(s.mark, ...p, colour)), svgMark(s.mark, left + 12, y, colour));
    for (const [x, v, label] of markTexts(s)) text(placeX(x), placeY(v) - textRise, label, "middle", colour, {"font-weight": 600});
    text(left + 32, y + 4, s.label, "start", ink);
  });
  (options.lines || []).filter(l => isNumber(l.x)).forEach((l, i, all) => {
    const y = upper - (all.length - i) * lineRow, x = placeX(l.x), isRight = x > left + 0.6 * width;
    svg.append(make("path", {d: `M${x} ${y}V${upper + height}`, stroke: l.colour, "stroke-width": 1.5, "stroke-dasharray": "6 4"}));
    text(x + (isRight ? -4 : 4), y + 11, l.label, isRight ? "end" : "start", l.colour);
  });
  return new XMLSerializer().serializeToString(svg);
}
