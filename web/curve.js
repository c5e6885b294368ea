// Convergence curves: reading curve.csv, choosing axes, and comparing at equal time or equal error.
import { note, table, warning } from "./dom.js";
import { number, seconds, words } from "./format.js";
import { metrics } from "./job_tables.js";

export const axes = [
  { key: "seconds", label: "render time", unit: "s" },
  { key: "cpu_seconds", label: "CPU time / threads", unit: "s" },
  { key: "iteration", label: "iterations", unit: "" },
];

export const slopeName = (slope) => (slope === -1 ? "−1" : "−1/2");

/// Rows of curve.csv as objects of numbers; null where a field is empty.
export function parseCurve(text) {
  const [head, ...lines] = text.split(/\r?\n/).filter((line) => line !== "").map((line) => line.split(","));
  return lines.map((fields) => Object.fromEntries(head.map((name, i) => [name, fields[i] ? Number(fields[i]) : null])));
}

/// The metrics with at least one value in a curve.
export const presentMetrics = (rows) => metrics.filter((m) => rows.some((row) => Number.isFinite(row[m.key])));

/// The points of a curve that log axes can show, in order of x. `floor`: at the reference's noise.
export function points(rows, x, y) {
  const referenced = metrics.find((m) => m.key === y)?.reference;
  return rows
    .filter((row) => row[x] > 0 && row[y] > 0)
    .map((row) => ({ x: row[x], y: row[y], floor: Boolean(referenced && row.at_floor) }))
    .sort((a, b) => a.x - b.x);
}

/// The value of `what` where `where` is `at`, interpolated in log-log between the point `after` and the one before it.
function between(curve, after, where, what, at) {
  const [a, b] = [curve[after - 1], curve[after]].map((p) => ({ u: Math.log(p[where]), v: Math.log(p[what]) }));
  return a.u === b.u ? curve[after][what] : Math.exp(a.v + ((Math.log(at) - a.u) / (b.u - a.u)) * (b.v - a.v));
}

/// The error at `x`, interpolated in log-log; null outside the curve.
export function errorAt(curve, x) {
  const after = curve.findIndex((p) => p.x >= x);
  if (curve[after]?.x === x) return curve[after].y;
  return after > 0 ? between(curve, after, "x", "y", x) : null;
}

/// The x from which on the error stays at or below `y`, interpolated in log-log; null if it ends above.
export function reaches(curve, y) {
  const after = curve.findLastIndex((p) => p.y > y) + 1;
  return after > 0 && after < curve.length ? between(curve, after, "y", "x", y) : curve[after]?.x ?? null;
}

/// The last instant that all curves reach, and 1/2, 1/4, 1/10 and 1/100 of it once all curves have begun; ascending.
export function commonInstants(curves) {
  const filled = curves.filter((c) => c.length > 0);
  const [first, last] = [Math.max(...filled.map((c) => c[0].x)), Math.min(...filled.map((c) => c.at(-1).x))];
  return [100, 10, 4, 2, 1].map((n) => last / n).filter((x) => x >= first);
}

/// The smallest error that all curves reach and keep; null if there are none.
export function commonError(curves) {
  const last = curves.filter((c) => c.length > 0).map((c) => c.at(-1).y);
  return last.length === 0 ? null : Math.max(...last);
}

/// The ends of the line of given slope fitted in log-log to the points above the floor; empty below two points.
export function slopeLine(curves, slope) {
  const all = curves.flat().filter((p) => !p.floor);
  if (all.length < 2) return [];
  const offset = all.reduce((sum, p) => sum + Math.log(p.y) - slope * Math.log(p.x), 0) / all.length;
  const xs = curves.flat().map((p) => p.x);
  return [Math.min(...xs), Math.max(...xs)].map((x) => ({ x, y: Math.exp(offset + slope * Math.log(x)) }));
}

/// A curve's rows as a table, also for users who cannot see the plot: all columns that have a value.
export function curveTable(rows) {
  const keys = Object.keys(rows[0] ?? {}).filter((key) => rows.some((row) => row[key] !== null));
  return table(keys.map(words), rows.map((row) => keys.map((key) => number(row[key], 4))), true);
}

const mostApart = 1.05;  // largest ratio of times that count as equal

/// A note on the render times of compared pictures: only the last of each job is kept.
export function aboutTimes(times) {
  const [least, most] = [Math.min(...times), Math.max(...times)];
  return most <= mostApart * least ? note("Of equal time: the jobs' last pictures, at most 5 % apart in render time.")
    : warning(`Not of equal time: the jobs' last pictures, after ${seconds(least)} to ${seconds(most)} of rendering.`);
}
