// How a number of the jobs' reports grows with another, or with a setting that they do not share.
import { words } from "./format.js";
import { leaves } from "./report.js";
import { differences } from "./settings_diff.js";

/// What replicates differ in, and what has no part in what is measured.
const beside = ["/seed", "/label", "/threads"];
const parts = ["integrator", "seconds", "counts", "rates", "errors"];  // of a report

const isPlace = (key) => key.startsWith("/");
const parsed = (text) => (text === "" ? null : JSON.parse(text));

/// "seconds render_cpu" -> 29.4, ... for the numbers of a report; none where there is no report.
const reported = (report) => new Map(parts.flatMap((part) => leaves(report?.[part] ?? {})
  .filter(({ value }) => typeof value === "number")
  .map(({ keys, value }) => [[part, ...keys.toReversed()].join(" "), value])));

/// What can be shown of jobs ([{job, report}]): {x, y}, each [{key, label, group, values}] with a value a
/// job, null where one has none. x: settings, as pointers, and numbers of the reports, of which two jobs
/// have different ones above 0; y: numbers of the reports.
export function quantities(jobs) {
  const settings = differences(jobs.map(({ job }) => job))
    .map(({ pointer, values }) => ({ key: pointer, label: pointer, group: "settings", values: values.map(parsed) }))
    .filter(({ key, values }) => !beside.includes(key) && values.some((v) => typeof v === "number"));
  const reports = jobs.map(({ report }) => reported(report));
  const measured = [...new Set(reports.flatMap((r) => [...r.keys()]))]
    .map((key) => ({ key, label: words(key), group: "report", values: reports.map((r) => r.get(key) ?? null) }));
  const differs = ({ values }) => new Set(values.filter((v) => v > 0)).size > 1;
  return { x: [...settings, ...measured].filter(differs), y: measured.filter(differs) };
}

/// The slope of a line through the logarithms of points, least squares; null if they have one x.
export function exponent(points) {
  const places = points.map((p) => [Math.log(p.x), Math.log(p.y)]);
  const mean = (k) => places.reduce((sum, p) => sum + p[k], 0) / places.length;
  const [u, v] = [mean(0), mean(1)];
  const across = places.reduce((sum, p) => sum + (p[0] - u) ** 2, 0);
  return across > 0 ? places.reduce((sum, p) => sum + (p[0] - u) * (p[1] - v), 0) / across : null;
}

/// The points of `y` over `x`, which quantities() gave, as curves [{name, points: [{x, y}]}]: jobs are one
/// curve if they share all settings but that of x, and, where x is of the reports, all but numbers.
export function scalingCurves(jobs, x, y) {
  const apart = differences(jobs.map(({ job }) => job)).filter(({ pointer, values }) => pointer !== x.key
    && !beside.includes(pointer) && (isPlace(x.key) || values.some((v) => typeof parsed(v) !== "number")));
  const curves = new Map();
  jobs.forEach((_, i) => {
    if (!(x.values[i] > 0 && y.values[i] > 0)) return;
    const name = apart.map(({ pointer, values }) => `${pointer.split("/").pop()} ${parsed(values[i]) ?? "—"}`).join(", ");
    if (!curves.has(name)) curves.set(name, []);
    curves.get(name).push({ x: x.values[i], y: y.values[i] });
  });
  return [...curves].map(([name, points]) => ({ name: name || "all", points: points.sort((a, b) => a.x - b.x) }));
}
