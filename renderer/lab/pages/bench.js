"use strict";
// Draws error against effort: lines for fixed samples per pixel, marks for stopping rules.

const benchErrors = [["rmseLightness", "RMSE of L"], ["relMse", "relMSE"], ["dssim", "1 \u2212 SSIM"], ["flip", "FLIP"], ["visibleDifference", "visible difference"], ["rmse", "RMSE"]];
// How the lines of each sampler, in their order, are dashed.
const benchDashes = [undefined, [7, 5], [2, 4], [12, 4, 2, 4]];
const benchEfforts = [["seconds", "seconds"], ["spp", "mean samples per pixel"]];

// Says whether most samples of the reference are a point's own, which tells little of its error.
const isTooNear = (data, p) => p.sharesReference && p.spp > data.cap / 2;

function benchSeries(data, error, effort) {
  const groups = new Map();
  for (const p of data.bench.points) {
    const key = p.rule + "\n" + (p.sampler || "");
    if (!groups.has(key)) groups.set(key, {rule: p.rule, sampler: p.sampler, points: []});
    groups.get(key).points.push(p);
  }
  const rules = [...new Set([...groups.values()].map(g => g.rule))];
  const samplers = data.bench.samplers;
  return [...groups.values()].map(g => {
    const points = g.points.filter(p => isNumber(p[error]) && p[error] > 0 && isNumber(p[effort]) && !isTooNear(data, p)).sort((a, b) => a[effort] - b[effort]);
    const k = rules.indexOf(g.rule);
    return {label: g.rule + (g.sampler ? ", " + g.sampler : ""), x: points.map(p => p[effort]), y: points.map(p => p[error]),
      colour: palette[k % palette.length], dash: benchDashes[Math.max(0, samplers.indexOf(g.sampler)) % benchDashes.length],
      mark: g.rule === "fixed" ? null : (k + 4) % 5, line: points.length > 1};
  }).filter(s => s.x.length);
}

// The visibility threshold, as a line from the least effort to the most.
function thresholdSeries(data, error, effort) {
  if (error !== "visibleDifference") return [];
  const x = data.bench.points.map(p => p[effort]).filter(isNumber), ends = [Math.min(...x), Math.max(...x)];
  return [{label: "visibility threshold", x: ends, y: ends.map(() => data.viewing.threshold), colour: "gray", dash: [2, 4], line: true}];
}

function startBench(data) {
  if (!data.bench) return;
  byId("bench").hidden = false;
  for (const p of data.bench.points) p.dssim = isNumber(p.ssim) ? 1 - p.ssim : null;
  let error = "rmseLightness";
  const draw = () => {
    const parent = byId("bench-charts");
    parent.replaceChildren();
    const label = benchErrors.find(e => e[0] === error)[1];
    for (const [effort, name] of benchEfforts)
      drawChart(parent, [...benchSeries(data, error, effort), ...thresholdSeries(data, error, effort)], {title: `${label} against ${name}`, xLabel: name, yLabel: label, logY: true, height: 420, endsVary: true});
    fitCharts();
  };
  byId("bench-controls").append(makeChoice("Error", benchErrors, error, v => { error = v; draw(); }));
  draw();
  if (data.bench.samplers.length > 1)
    byId("bench-table").append(make("p", {class: "small"}, `Lines: ${data.bench.samplers.map((s, i) => s + " " + ["full", "dashed", "dotted", "dashed and dotted"][i]).join(", ")}.`));
  if (data.bench.points.some(p => isTooNear(data, p)))
    byId("bench-table").append(make("p", {class: "small"}, "Left out of the charts: points of which the reference shares the samples, beyond half the cap."));
  const table = makeTable("All points", ["rule", "setting", "sampler", "mean spp", "seconds", "RMSE of L", "relMSE", "SSIM", "FLIP", "visible"],
    data.bench.points.map(p => [p.rule, String(p.setting ?? ""), p.sampler || "", show(p.spp), show(p.seconds), show(p.rmseLightness), show(p.relMse), show(p.ssim, 5), show(p.flip), show(p.visibleDifference)]));
  byId("bench-table").append(make("div", {class: "scroll"}, withCsv(table, "points")));
}

function sayBench(data) {
  const rules = [...new Set(data.bench.points.map(p => p.rule))].filter(r => r !== "fixed");
  return (rules.length ? `${rules.join(", ")} compared with` : "Error of") + ` fixed sample counts: ${data.bench.points.length} points, against a reference of ${showCount(data.cap)}.`;
}
