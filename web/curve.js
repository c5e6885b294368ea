// Convergence curves: reading curve.csv, choosing axes, and comparing at equal time or equal error.

/// What the x axis can show.
export const axes = [
  { key: "seconds", label: "render time", unit: "s" },
  { key: "cpu_seconds", label: "CPU time / threads", unit: "s" },
  { key: "iteration", label: "iterations", unit: "" },
];

/// What the y axis can show, the preferred first; radiance is in the scene's own unit. A Monte Carlo
/// estimate's error falls as x^slope: squared errors with the samples, the others with their root.
export const metrics = [
  { key: "rmse", label: "RMSE", unit: "radiance", slope: -0.5 },
  { key: "relmse", label: "relMSE", unit: "", slope: -1 },
  { key: "mse", label: "MSE", unit: "radiance²", slope: -1 },
  { key: "mae", label: "MAE", unit: "radiance", slope: -0.5 },
  { key: "smape", label: "SMAPE", unit: "", slope: -0.5 },
  { key: "est_rmse", label: "estimated RMSE", unit: "radiance", slope: -0.5 },
];

export const slopeName = (slope) => (slope === -1 ? "−1" : "−1/2");

function parseField(text) {
  if (text === "" || text === undefined) return null;
  if (text === "true" || text === "false") return text === "true" ? 1 : 0;
  return Number(text);
}

/// Rows of curve.csv as objects of numbers; null where a field is empty.
export function parseCurve(text) {
  const lines = text.split(/\r?\n/).filter((line) => line !== "");
  if (lines.length === 0) return [];
  const names = lines[0].split(",").map((name) => name.trim());
  return lines.slice(1).map((line) => {
    const fields = line.split(",");
    return Object.fromEntries(names.map((name, i) => [name, parseField(fields[i]?.trim())]));
  });
}

/// The metrics with at least one value in a curve.
export const presentMetrics = (rows) =>
  metrics.filter((m) => rows.some((row) => Number.isFinite(row[m.key])));

/// The points of a curve that log axes can show, in order of x. `floor`: the reference's own noise
/// is reached there (it says nothing about est_rmse, which needs no reference).
export function points(rows, x, y) {
  return rows
    .filter((row) => row[x] > 0 && row[y] > 0)
    .map((row) => ({ x: row[x], y: row[y], floor: y !== "est_rmse" && Boolean(row.at_floor) }))
    .sort((a, b) => a.x - b.x);
}

function between(a, b, from, to, at) {
  if (from === to) return b;
  const t = (Math.log(at) - Math.log(from)) / (Math.log(to) - Math.log(from));
  return Math.exp(Math.log(a) + t * (Math.log(b) - Math.log(a)));
}

/// The error at `x`, interpolated in log-log; null outside the curve.
export function errorAt(curve, x) {
  const after = curve.findIndex((p) => p.x >= x);
  if (after < 0) return null;
  if (curve[after].x === x) return curve[after].y;
  if (after === 0) return null;
  const [a, b] = [curve[after - 1], curve[after]];
  return between(a.y, b.y, a.x, b.x, x);
}

/// The x at which the error first is at or below `y`, interpolated in log-log; null if never.
export function reaches(curve, y) {
  const after = curve.findIndex((p) => p.y <= y);
  if (after < 0) return null;
  if (after === 0) return curve[0].x;
  const [a, b] = [curve[after - 1], curve[after]];
  return between(a.x, b.x, a.y, b.y, y);
}

/// The instants at which curves can be compared: the last one that all of them reach, and
/// 1/2, 1/4, 1/10 and 1/100 of it where all of them have begun. Ascending; empty if they share none.
export function commonInstants(curves) {
  const filled = curves.filter((c) => c.length > 0);
  if (filled.length === 0) return [];
  const first = Math.max(...filled.map((c) => c[0].x));
  const last = Math.min(...filled.map((c) => c[c.length - 1].x));
  return [100, 10, 4, 2, 1].map((n) => last / n).filter((x) => x >= first);
}

/// The smallest error that all curves reach; null if there are none.
export function commonError(curves) {
  const filled = curves.filter((c) => c.length > 0);
  if (filled.length === 0) return null;
  return Math.max(...filled.map((c) => Math.min(...c.map((p) => p.y))));
}

/// Two ends of the line of the given slope that lies amid the points (least squares in log-log),
/// from the first x to the last. Points at the floor do not count. Empty below two points.
export function slopeLine(curves, slope) {
  const all = curves.flat().filter((p) => !p.floor);
  if (all.length < 2) return [];
  const offset = all.reduce((sum, p) => sum + Math.log(p.y) - slope * Math.log(p.x), 0) / all.length;
  const xs = curves.flat().map((p) => p.x);
  return [Math.min(...xs), Math.max(...xs)]
    .map((x) => ({ x, y: Math.exp(offset + slope * Math.log(x)) }));
}
