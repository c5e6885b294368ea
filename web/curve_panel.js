// Error curves of jobs: reads and follows them, with unique names, and plots them with controls, or as a single figure.
import { getJob, getText, poll } from "./api.js";
import { axes, parseCurve, points, presentMetrics } from "./curve.js";
import { addressOf, choice, chooser, h, problem, replace, small, update } from "./dom.js";
import { figureBox } from "./figure.js";
import { integratorName, isTerminal, jobTitle } from "./format.js";
import { metrics } from "./job_tables.js";

const everyMs = 5000;

/// A job with its curve and its report. A job that has ended is read once.
async function readJob(id, before, signal) {
  if (before && isTerminal(before.state.state)) return before;
  const job = await getJob(id, signal);
  const has = (name) => job.files.find((f) => f.name === name);
  const rows = has("curve.csv") ? parseCurve(await getText(id, "curve.csv", signal)) : [];
  const report = has("report.json") ? JSON.parse(await getText(id, "report.json", signal)) : null;
  return { ...job, rows, report };
}

/// Jobs with a `name`, "label, integrator"; equal names are extended by the end of the id.
function named(jobs) {
  const plain = jobs.map(({ job }) => `${jobTitle(job)}, ${integratorName(job.integrator)}`);
  const alone = (name) => plain.indexOf(name) === plain.lastIndexOf(name);
  return jobs.map((job, i) => (
    { ...job, name: alone(plain[i]) ? plain[i] : `${plain[i]} (${job.id.split("-").pop()})` }));
}

/// Reads the jobs, repeatedly while any of them runs, and calls `draw` with {jobs, preferred, problems}: the jobs with
/// a `name` and their curve in `rows`, the metric to show, and errors of jobs that could not be read.
export function followJobs(ids, draw, signal) {
  const read = new Map();
  return poll(async () => {
    const results = await Promise.allSettled(ids.map((id) => readJob(id, read.get(id), signal)));
    signal.throwIfAborted();
    results.forEach(({ value }, i) => value && read.set(ids[i], value));
    const jobs = ids.map((id) => read.get(id)).filter(Boolean);
    const reported = new Set(jobs.map(({ progress }) => progress?.error_metric));
    draw({
      jobs: named(jobs), preferred: reported.size === 1 ? [...reported][0] : null,
      problems: results.flatMap(({ reason }, i) => (reason ? [`${ids[i]}: ${reason.message}`] : [])),
    });
    return jobs.some((job) => !isTerminal(job.state.state));
  }, everyMs, signal);
}

export const idsOf = (query) => [...new Set((query.get("jobs") ?? "").split(",").filter(Boolean))];

/// A plot and its controls; the choice, `x` and `y`, is in `query` and the URL. `show(series, preferred)` draws the
/// chosen metric of [{name, rows}], else `preferred`, else the first that all have, and calls `drawn(axis, metric)`.
export function curvePanel(query, drawn = () => {}) {
  const figure = figureBox("No errors have been measured.");
  const switches = h("div.switches");
  let series = [];
  let preferred = null;
  let metric;

  const embedded = query.has("embed");
  const alone = () => small(embedded ? "Leave the figure" : "Figure alone", () => {
    if (embedded) query.delete("embed");
    else query.set("embed", "");
    location.hash = addressOf(query);
  });

  const choose = chooser(query, draw);
  function draw() {
    const has = series.map(({ rows }) => presentMetrics(rows));
    const offered = metrics.filter((m) => has.some((present) => present.includes(m)));
    const pick = (key) => offered.find((m) => m.key === key);
    const axis = axes.find((a) => a.key === query.get("x")) ?? axes[0];
    metric = pick(query.get("y")) ?? pick(preferred)
      ?? offered.find((m) => has.every((present) => present.includes(m))) ?? offered[0];
    switches.hidden = metric === undefined;
    update(switches,
      choice("Error", offered, metric?.key, choose("y")), choice("against", axes, axis.key, choose("x")),
      h("span.tools", alone(), figure.saveButton("", () => `lacuna-${metric.key}`)));
    figure.draw({ axis, metric, curves: series.map(({ name, rows }, index) => (
      { name, index, points: metric ? points(rows, axis.key, metric.key) : [] })) });
    drawn(axis, metric);
  }

  return {
    element: h("div", switches, figure.element),
    show(...given) {
      [series, preferred] = given;
      draw();
    },
  };
}

/// The curves of one or more jobs as a single figure, for saving or embedding.
export async function show(main, { params, query, signal }) {
  document.title = "Figure · Lacuna";
  const panel = curvePanel(query);
  const notes = h("div");
  replace(main, notes, panel.element);
  await followJobs(params.id ? [params.id] : idsOf(query), ({ jobs, preferred, problems }) => {
    update(notes, problems.map(problem));
    panel.show(jobs, preferred);
  }, signal);
}
