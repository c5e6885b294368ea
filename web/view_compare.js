// Several jobs over one another: curves, error at equal time, time to equal error, pictures.
import { isTerminal, poll } from "./api.js";
import { comparePictures } from "./compare_pictures.js";
import { axes, commonError, commonInstants, errorAt, metrics, points, reaches }
  from "./curve.js";
import { curvePanel } from "./curve_panel.js";
import { append, h, table } from "./dom.js";
import { number, significant } from "./format.js";
import { idsOf, names, readJob, reportedMetric } from "./series.js";
import { differences, doubtful } from "./settings_diff.js";

const everyMs = 5000;

/// How many times `value` is as large as the best; the best itself is 1.
const ratio = (value, best) => (value === null || best === null ? "—" : `${significant(value / best)}×`);

function equalTimes(series, axis, metric) {
  const curves = series.map((s) => points(s.rows, axis.key, metric.key));
  const instants = commonInstants(curves);
  const target = commonError(curves);
  if (target === null) return h("p", { className: "note" }, "No errors have been measured.");
  const at = (x) => `${significant(x)}${axis.unit ? ` ${axis.unit}` : ""}`;
  const times = curves.map((c) => reaches(c, target));
  const fastest = Math.min(...times.filter((t) => t !== null));
  const lowest = instants.map((x) => Math.min(...curves.map((c) => errorAt(c, x) ?? Infinity)));
  const errorCell = (error, best) => (error === best
    ? h("strong", {}, number(error)) : number(error));
  const heads = [
    "Job",
    ...instants.map((x) => ({ title: `at ${at(x)}`, number: true })),
    { title: `${axis.label} to reach ${number(target)}`, number: true },
    { title: "× the fastest", number: true },
  ];
  const rows = curves.map((c, i) => [
    series[i].name,
    ...instants.map((x, k) => errorCell(errorAt(c, x), lowest[k])),
    times[i] === null ? "—" : at(times[i]),
    ratio(times[i], fastest),
  ]);
  return [
    table(heads, rows, "values"),
    h("p", { className: "note" }, `${metric.label}, interpolated in log-log. `,
      instants.length === 0 && "The curves share no instant. ",
      `${number(target)} is the smallest error that all of them reach.`),
  ];
}

function differenceTable(jobs, labels) {
  const found = differences(jobs.map(({ job }) => job));
  if (found.length === 0) return h("p", { className: "note" }, "The job files are the same.");
  return table(["", ...labels], found.map((d) => [d.pointer, ...d.values]), "values");
}

function warning(jobs) {
  const found = doubtful(differences(jobs.map(({ job }) => job)));
  return found.length > 0 && h("p", { className: "warning" },
    `These jobs differ in ${found.join(", ")}: their errors may not be comparable.`);
}

function noJobs() {
  return h("p", {}, "Choose two or more in the ", h("a", { href: "#/" }, "list of jobs"),
    ", or name them in the address: ", h("code", {}, "#/compare?jobs=ID,ID"), ".");
}

export async function show(main, { query, signal }) {
  document.title = "Compare · Lacuna";
  const ids = idsOf(query);
  main.append(h("h1", {}, "Compare"));
  if (ids.length === 0) {
    main.append(noJobs());
    return;
  }
  const read = new Map();
  const notes = h("div", { className: "notes" });
  const times = h("section");
  const settings = h("section");
  let drawn = () => {};
  function remember() {
    const rest = new URLSearchParams(query);
    rest.delete("jobs");
    history.replaceState(null, "", `#/compare?jobs=${ids.join(",")}&${rest}`);
  }
  const pictures = comparePictures(query, remember, signal);
  const panel = curvePanel(query, () => {
    remember();
    drawn();
  }, signal);

  function drawTimes(series) {
    const metric = metrics.find((m) => m.key === panel.y);
    const axis = axes.find((a) => a.key === panel.x);
    times.replaceChildren(h("h2", {}, "Error at equal time"));
    append(times, [metric ? equalTimes(series, axis, metric)
      : h("p", { className: "note" }, "No errors have been measured.")]);
  }

  function draw(jobs, problems) {
    const labels = names(jobs);
    const series = jobs.map((job, i) => ({ name: labels[i], rows: job.rows }));
    notes.replaceChildren();
    append(notes, [problems.map((text) => h("p", { className: "problem" }, text)), warning(jobs)]);
    panel.show(series, reportedMetric(jobs));
    drawn = () => drawTimes(series);
    drawn();
    settings.replaceChildren(h("h2", {}, "Settings that differ"), differenceTable(jobs, labels));
    pictures.show(jobs, labels).catch((error) => {
      if (!signal.aborted) append(notes, [h("p", { className: "problem" }, error.message)]);
    });
  }

  main.append(notes, panel.element, times,
    h("section", {}, h("h2", {}, "Pictures"), pictures.element), settings);
  await poll(async () => {
    const results = await Promise.allSettled(ids.map((id) => readJob(id, read.get(id), signal)));
    signal.throwIfAborted();
    const problems = [];
    results.forEach((result, i) => {
      if (result.status === "fulfilled") read.set(ids[i], result.value);
      else problems.push(`${ids[i]}: ${result.reason.message}`);
    });
    draw(ids.map((id) => read.get(id)).filter(Boolean), problems);
    return [...read.values()].some((job) => !isTerminal(job.state.state));
  }, everyMs, signal);
}
