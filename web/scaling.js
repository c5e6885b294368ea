// The differences between jobs, and how a number in their reports scales with a setting or another number.
import { choice, chooser, h, note, update } from "./dom.js";
import { figureBox } from "./figure.js";
import { significant, words } from "./format.js";
import { inTheLight, notInAReference } from "./job_tables.js";
import { leaves } from "./report.js";

/// "/integrator/max_depth" -> 6, ... for every value of a job file.
const settings = (job) => new Map(leaves(job).map(({ keys, value }) =>
  [`/${keys.toReversed().join("/")}`, JSON.stringify(value)]));

/// The pointers whose values differ between the jobs' files, each with a value per job ("": missing).
export function differences(files) {
  const all = files.map(settings);
  return [...new Set(all.flatMap((one) => [...one.keys()]))]
    .map((pointer) => ({ pointer, values: all.map((one) => one.get(pointer) ?? "") }))
    .filter(({ values }) => values.some((value) => value !== values[0]));
}

/// The `differences` that may change the estimated picture, including keys unknown to the page.
export const doubtful = (found) => found.map((d) => d.pointer)
  .filter((pointer) => inTheLight.includes(pointer) || !notInAReference.includes(pointer.split("/")[1]));
/// Keys in which replicates differ, and keys that do not affect measurements.
const beside = ["/seed", "/label", "/threads"];
const parts = ["integrator", "seconds", "counts", "rates", "errors"];  // of a report
const parsed = (text) => (text === "" ? null : JSON.parse(text));

/// "seconds render_cpu" -> 29.4, ... for the numbers of a report; none without a report.
const reported = (report) => new Map(parts.flatMap((part) => leaves(report?.[part] ?? {})
  .filter(({ value }) => typeof value === "number")
  .map(({ keys, value }) => [[part, ...keys.toReversed()].join(" "), value])));

/// The quantities that can be plotted: {x, y}, each [{key, label, group, values}] with a value per job or null, and at
/// least two different positive ones. x: settings, as pointers, and numbers of the reports; y: the latter.
function quantities(jobs) {
  const set = differences(jobs.map(({ job }) => job))
    .map(({ pointer, values }) => ({ key: pointer, label: pointer, group: "settings", values: values.map(parsed) }))
    .filter(({ key, values }) => !beside.includes(key) && values.some((v) => typeof v === "number"));
  const reports = jobs.map(({ report }) => reported(report));
  const measured = [...new Set(reports.flatMap((r) => [...r.keys()]))]
    .map((key) => ({ key, label: words(key), group: "report", values: reports.map((r) => r.get(key) ?? null) }));
  const differs = ({ values }) => new Set(values.filter((v) => v > 0)).size > 1;
  return { x: [...set, ...measured].filter(differs), y: measured.filter(differs) };
}

/// The slope of a line through the logarithms of points, least squares; null if they have one x.
function exponent(points) {
  const places = points.map((p) => [Math.log(p.x), Math.log(p.y)]);
  const mean = (k) => places.reduce((sum, p) => sum + p[k], 0) / places.length;
  const [u, v] = [mean(0), mean(1)];
  const across = places.reduce((sum, p) => sum + (p[0] - u) ** 2, 0);
  return across > 0 ? places.reduce((sum, p) => sum + (p[0] - u) * (p[1] - v), 0) / across : null;
}

/// The points of `y` over `x`, both of quantities(), as curves of a figure: jobs form one curve if they share all
/// settings except x's and, if x is from the reports, all except numbers.
function scalingCurves(jobs, x, y) {
  const apart = differences(jobs.map(({ job }) => job)).filter(({ pointer, values }) => pointer !== x.key
    && !beside.includes(pointer) && (x.group === "settings" || values.some((v) => typeof parsed(v) !== "number")));
  const curves = new Map();
  jobs.forEach((_, i) => {
    if (!(x.values[i] > 0 && y.values[i] > 0)) return;
    const name = apart.map((d) => `${d.pointer.split("/").pop()} ${parsed(d.values[i]) ?? "—"}`).join(", ");
    if (!curves.has(name)) curves.set(name, []);
    curves.get(name).push({ x: x.values[i], y: y.values[i] });
  });
  return [...curves].map(([name, points], index) => {
    const slope = exponent(points);
    return { name: `${name || "all"}${slope === null ? "" : `: ∝ x^${significant(slope, 2)}`}`, index,
      points: points.sort((a, b) => a.x - b.x) };
  });
}

/// A figure and its controls; `query` stores the choice, `sx` and `sy`. `show(jobs)` draws jobs with their reports; the
/// panel is hidden while they do not differ.
export function scalingPanel(query) {
  const figure = figureBox("No report contains both quantities.");
  const switches = h("div.switches");
  const element = h("section", h("h2", "Scaling"), switches, figure.element,
    note("The exponent of a power law of x, fitted to the logarithms of each curve."));

  function show(jobs) {
    const offered = quantities(jobs);
    element.hidden = offered.x.length === 0 || offered.y.length === 0;
    if (element.hidden) return;
    const choose = chooser(query, () => show(jobs));
    const pick = (of, key) => of.find((q) => q.key === key);
    const x = pick(offered.x, query.get("sx")) ?? offered.x[0];
    const y = pick(offered.y, query.get("sy")) ?? pick(offered.y, "seconds render_cpu") ?? offered.y[0];
    update(switches, choice("Number", offered.y.map(({ key, label }) => ({ key, label })), y.key, choose("sy")),
      choice("over", offered.x, x.key, choose("sx")), h("span.tools", figure.saveButton("scaling ", () => "lacuna-scaling")));
    figure.draw({ curves: scalingCurves(jobs, x, y), axis: x, metric: y });
  }
  return { element, show };
}
