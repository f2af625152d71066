"use strict";
// Saves charts as SVG, and charts and tables as CSV.

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
    text(left + 32, y + 4, s.label, "start", ink);
  });
  (options.lines || []).filter(l => isNumber(l.x)).forEach((l, i, all) => {
    const y = upper - (all.length - i) * lineRow, x = placeX(l.x), isRight = x > left + 0.6 * width;
    svg.append(make("path", {d: `M${x} ${y}V${upper + height}`, stroke: l.colour, "stroke-width": 1.5, "stroke-dasharray": "6 4"}));
    text(x + (isRight ? -4 : 4), y + 11, l.label, isRight ? "end" : "start", l.colour);
  });
  return new XMLSerializer().serializeToString(svg);
}
