"use strict";
// Draws error against effort: lines for fixed samples per pixel, marks for stopping rules.

const curveErrors = [["rmseLightness", "RMSE of L"], ["relMse", "relMSE"], ["dssim", "1 \u2212 SSIM"], ["flip", "FLIP"], ["visibleDifference", "visible difference"], ["rmse", "RMSE"]];
const curveEfforts = [["seconds", "seconds"], ["spp", "mean samples per pixel"]];

// Says whether most samples of the reference are a point's own, which tells little of its error.
const isTooNear = (data, p) => data.errorCurves.sharesReference && p.spp > data.cap / 2;

function curveSeries(data, error, effort) {
  const rules = [...new Set(data.errorCurves.points.map(p => p.rule))];
  return rules.map((rule, k) => {
    const points = data.errorCurves.points.filter(p => p.rule === rule && isNumber(p[error]) && p[error] > 0 && isNumber(p[effort]) && !isTooNear(data, p)).sort((a, b) => a[effort] - b[effort]);
    return {label: rule, x: points.map(p => p[effort]), y: points.map(p => p[error]), colour: palette[k % palette.length],
      mark: rule === "fixed" ? null : (k + 4) % 5, line: points.length > 1};
  }).filter(s => s.x.length);
}

// The visibility threshold, as a line from the least effort to the most.
function thresholdSeries(data, error, effort) {
  if (error !== "visibleDifference") return [];
  const x = data.errorCurves.points.map(p => p[effort]).filter(isNumber), ends = [Math.min(...x), Math.max(...x)];
  return [{label: "visibility threshold", x: ends, y: ends.map(() => data.viewing.threshold), colour: "gray", dash: [2, 4], line: true}];
}

function startErrorCurves(data) {
  if (!data.errorCurves) return;
  byId("error-curves").hidden = false;
  for (const p of data.errorCurves.points) p.dssim = isNumber(p.ssim) ? 1 - p.ssim : null;
  let error = "rmseLightness";
  const draw = () => {
    const parent = byId("error-charts");
    parent.replaceChildren();
    const label = curveErrors.find(e => e[0] === error)[1];
    for (const [effort, name] of curveEfforts)
      drawChart(parent, [...curveSeries(data, error, effort), ...thresholdSeries(data, error, effort)], {title: `${label} against ${name}`, xLabel: name, yLabel: label, logY: true, height: 420, endsVary: true});
    fitCharts();
  };
  byId("error-controls").append(makeChoice("Error", curveErrors, error, v => { error = v; draw(); }));
  draw();
  if (data.errorCurves.points.some(p => isTooNear(data, p)))
    byId("error-table").append(make("p", {class: "small"}, "Left out of the charts: points of which the reference shares the samples, beyond half the cap."));
  const table = makeTable("All points", ["rule", "setting", "mean spp", "seconds", "RMSE of L", "relMSE", "SSIM", "FLIP", "visible"],
    data.errorCurves.points.map(p => [p.rule, String(p.setting ?? ""), show(p.spp), show(p.seconds), show(p.rmseLightness), show(p.relMse), show(p.ssim, 5), show(p.flip), show(p.visibleDifference)]));
  byId("error-table").append(make("div", {class: "scroll"}, withCsv(table, "points")));
}
