// The sweeps, newest first, and one sweep: the live comparison of its settings.
import { cancelSweep, curlLine, getAnswers, getJob, getSweep, getSweeps, poll, removeSweep, tableUrl } from "./api.js";
import { answersView, summary } from "./answers.js";
import { action, append, ask, button, copyButton, emptyPlace, h, note, problem, replace, table, update }
  from "./dom.js";
import { badge, figureName, isTerminal, number, prettyJob, progressBar, when, withoutNulls } from "./format.js";
import { jobPictures } from "./job_pictures.js";
import { describe } from "./view_compare.js";

const listMs = 2000;
const answersMs = 4000;
const answersShare = 0.01;  // of all time: viewing a large sweep must not disturb its timings

const example = {
  label: "next event estimation",
  job: { scene: "SCENE.glb", budget: { seconds: 10 }, reference: "auto" },
  axes: { "/integrator/next_event_estimation": [true, false], "/integrator/max_depth": [4, 8] },
  seeds: 3, baseline: { "/integrator/next_event_estimation": false },
};

const shareBar = ({ state, share }) => progressBar("Share of the runs", "running", state === "running" && { share });

function row(sweep) {
  const { failed = 0, done = 0 } = sweep.counts;
  return [
    h("a", { href: `#/sweep/${sweep.id}` }, sweep.label || sweep.id), badge(sweep.state), shareBar(sweep),
    `${number(done)} of ${number(sweep.run_count)}`, failed > 0 ? h("span.failed", number(failed)) : "0",
    when(sweep.created),
  ];
}

async function showAll(main, { signal }) {
  document.title = "Sweeps · Lacuna";
  await poll(async () => {
    const sweeps = await getSweeps(signal);
    update(main, h("h1", "Sweeps"), sweeps.length === 0 ? emptyPlace("No sweeps yet",
      "A sweep is many jobs that differ in some settings. Post one from a shell:", curlLine("sweeps", example))
      : table(["Sweep", "State", "", "Runs done", "Failed", "Created"], sweeps.map(row)));
  }, listMs, signal);
}

/// The file of a figure (docs/figures.md) of some `cells` of a picture, whose cells are `all`; `screen`: see viewer().
function figureOf(sweep, cells, all, names, { scene, ...screen }) {
  const shared = Object.entries(all[0].settings).filter(([key, value]) =>
    all.every(({ settings }) => JSON.stringify(settings[key]) === JSON.stringify(value)));
  return { sweep, scenes: [{ name: "Scene", settings: Object.fromEntries(shared), ...scene }],
    methods: cells.map(({ cell, settings }) => ({ name: figureName(names.get(cell)), settings })), ...screen };
}

/// The pictures of the first finished run of each chosen cell of a sweep, in the viewer of jobs.
function cellPictures(sweep, query, signal, failed) {
  const pictures = jobPictures(query, signal, describe);
  const read = new Map();
  const empty = note("No run of these cells is done yet.");
  async function load(runs) {
    for (const { id } of runs) {
      if (!read.has(id)) read.set(id, await getJob(id, signal));
    }
    await pictures.show(runs.map(({ id, name }) => ({ ...read.get(id), name })));
  }
  return (number, cells, names, all) => {
    const runs = cells.map((c) => ({ name: names.get(c.cell), id: c.runs.find((r) => r.state === "done")?.job }))
      .filter(({ id }) => id);
    load(runs).catch((error) => { if (!signal.aborted) failed(error.message); });
    return [h("h2", "Pictures of the shown cells"), runs.length === 0 ? empty
      : [pictures.figureButton((screen) => figureOf(sweep, cells, all, names, screen)), pictures.element]];
  };
}

/// Runs to check: failed ones, and those whose timings were disturbed.
function doubtfulRuns(answers) {
  const rows = answers.cells.flatMap((cell) => cell.runs
    .filter((r) => r.tainted || r.state === "failed")
    .map((r) => [h("a", { href: `#/job/${r.job}` }, r.name), cell.text, r.state, r.tainted ?? ""]));
  return rows.length > 0 && h("details", h("summary", `${rows.length} runs to check`),
    table(["Run", "Settings", "State", "Disturbed by"], rows));
}

function sweepSource(spec) {
  const command = curlLine("sweeps", withoutNulls(spec));
  return h("details", h("summary", "Sweep file"), h("pre.tall", { tabIndex: 0 }, prettyJob(spec)),
    h("pre.tall", { tabIndex: 0 }, command), copyButton(command));
}

async function showOne(main, { params: { id }, query, signal }) {
  if (!query.has("mode")) query.set("mode", "crops");  // side by side, as cells are compared
  const [title, refusal, about, runs, source] = [h("div.title"), h("div"), h("p"), h("div"), h("section")];
  const say = (text) => replace(refusal, text && problem(text));
  const danger = { className: "danger" };
  const cancel = () => button("Cancel sweep", action(() => ask("Cancel this sweep?",
    "What its runs have rendered so far is kept.", "Cancel sweep", () => cancelSweep(id)), step, say), danger);
  const remove = () => button("Delete …", action(() => ask("Delete this sweep?",
    "This also deletes all its jobs, with their pictures, curves and reports.", "Delete for good",
    () => removeSweep(id)), () => { location.hash = "#/sweeps"; }, say), danger);
  const view = answersView(query, cellPictures(id, query, signal, say));
  append(main, title, h("p.id", id), refusal, about, view.element, runs, source);

  let took = 0;
  async function step() {
    const asked = performance.now();
    const [sweep, answers] = await Promise.all([getSweep(id, signal), getAnswers(id, signal)]);
    took = performance.now() - asked;
    const over = isTerminal(sweep.state);
    document.title = `${sweep.label || "Sweep"} · Lacuna`;
    update(title, h("h1", sweep.label || "Sweep"), badge(sweep.state), shareBar(sweep), h("div.tools.actions",
      // Above elements that are drawn late, so that no picture moves the links.
      h("a", { href: `#/?sweep=${id}` }, "its runs"),
      h("a", { href: tableUrl(id), download: `${id}.csv` }, "table.csv"),
      over ? remove() : cancel()));
    update(about, `${summary(answers)}. Created ${when(sweep.created)}.`);
    view.show(answers);
    replace(runs, doubtfulRuns(answers));
    if (!source.firstChild) append(source, sweepSource(sweep.spec));
    return !over;
  }
  await poll(step, () => Math.max(answersMs, took / answersShare), signal);
}

export const show = (main, given) => (given.params.id ? showOne : showAll)(main, given);
