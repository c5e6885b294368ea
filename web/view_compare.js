// Comparison of jobs: curves, error at equal time, time to equal error, pictures.
import { commonError, commonInstants, errorAt, points, reaches } from "./curve.js";
import { curvePanel, followJobs, idsOf } from "./curve_panel.js";
import { append, h, note, problem, replace, table, update, warning } from "./dom.js";
import { figureName, number, significant, thin } from "./format.js";
import { jobPictures } from "./job_pictures.js";
import { differences, doubtful, scalingPanel } from "./scaling.js";
import { noViewer } from "./viewer.js";

function equalTimes(series, axis, metric) {
  const curves = metric ? series.map((s) => points(s.rows, axis.key, metric.key)) : [];
  const instants = commonInstants(curves);
  const target = commonError(curves);
  if (target === null) return note("No errors have been measured.");
  const at = (x) => `${significant(x)}${thin}${axis.unit}`;
  const times = curves.map((c) => reaches(c, target));
  const fastest = Math.min(...times.filter((t) => t !== null));
  const lowest = instants.map((x) => Math.min(...curves.map((c) => errorAt(c, x) ?? Infinity)));
  const errorCell = (error, best) => h(error === best ? "strong" : "span", {}, number(error));
  const heads = ["Job", ...instants.map((x) => `at ${at(x)}`), `${axis.label} to reach ${number(target)}`,
    "× the fastest"];
  const rows = curves.map((c, i) => [
    series[i].name,
    ...instants.map((x, k) => errorCell(errorAt(c, x), lowest[k])),
    ...(times[i] === null ? ["—", "—"] : [at(times[i]), `${significant(times[i] / fastest)}×`]),
  ]);
  return [
    table(heads, rows, true),
    note(`${metric.label}, interpolated in log-log. `,
      instants.length === 0 && "The curves have no common time. ",
      `${number(target)} is the smallest error that all of them reach.`),
  ];
}

/// The file of a figure (docs/figures.md) with a column for each job; `screen`: see viewer().
const figureOf = (jobs, metric, { scene, ...screen }) => ({
  scenes: [{ name: figureName(jobs[0].job.scene.replace(/\.\w+$/, "")), ...scene }],
  methods: jobs.map(({ id, name }) => ({ name: figureName(name), jobs: [id] })),
  metrics: metric ? [metric.key] : [], ...screen });

/// The caption of a picture that the viewer cannot show.
export const describe = ({ id, name, layers, drawable }) => ({ alt: `Picture of ${name}`, caption: [
  h("a", { href: `#/job/${id}` }, name), !drawable ? noViewer
    : `${layers ? "Size differs from the first" : "No layers.json"}: image.png, each at its own exposure.`] });

export async function show(main, { query, signal }) {
  document.title = "Compare · Lacuna";
  const ids = idsOf(query);
  replace(main, h("h1", "Compare"));
  if (ids.length === 0) {
    append(main, h("p", "Choose two or more in the ", h("a", { href: "#/" }, "list of jobs"),
      ", or name them in the address: ", h("code", "#/compare?jobs=ID,ID"), "."));
    return;
  }
  const [notes, times, settings] = [h("div.notes"), h("section"), h("section")];
  const pictures = jobPictures(query, signal, describe);
  let metric;
  const panel = curvePanel(query, (...shown) => {
    [, metric] = shown;
    update(times, h("h2", "Error at equal time"), equalTimes(compared, ...shown));
  });
  const scaling = scalingPanel(query);
  let compared = [];

  function draw({ jobs, preferred, problems }) {
    compared = jobs;
    const found = differences(jobs.map(({ job }) => job));
    const doubts = doubtful(found);
    update(notes, problems.map(problem), doubts.length > 0 && warning(
      `These jobs differ in ${doubts.join(", ")}: their errors may not be comparable.`));
    panel.show(jobs, preferred);
    scaling.show(jobs);
    update(settings, h("h2", "Settings that differ"), found.length === 0 ? note("The job files are the same.")
      : table(["", ...jobs.map(({ name }) => name)], found.map((d) => [d.pointer, ...d.values])));
    pictures.show(jobs).catch((error) => { if (!signal.aborted) append(notes, problem(error.message)); });
  }

  append(main, notes, panel.element, times,
    h("section", h("h2", "Pictures"), pictures.figureButton((screen) => figureOf(compared, metric, screen)),
      pictures.element), scaling.element, settings);
  await followJobs(ids, draw, signal);
}
