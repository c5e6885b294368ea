// One sweep: what its runs say about its settings, live while they are done.
import { getJob, poll } from "./api.js";
import { answersView, summary } from "./answers_view.js";
import { comparePictures } from "./compare_pictures.js";
import { ask } from "./dialog.js";
import { button, copyButton, h, note, problem, remember, replace, setText, table } from "./dom.js";
import { prettyJob, when, withoutNulls } from "./format.js";
import { badge, progressBar } from "./status.js";
import { cancelSweep, getAnswers, getSweep, removeSweep, sweepCurl, tableUrl } from "./sweeps_api.js";

const everyMs = 4000;
const share = 0.01;  // of all time: whoever looks at a large sweep must not disturb its times
const style = h("link", { rel: "stylesheet", href: "/sweep.css" });
const isOver = (state) => ["done", "cancelled", "failed"].includes(state);

/// The pictures of the first finished run of each chosen cell, in the viewer of jobs.
function cellPictures(query, signal, failed) {
  const pictures = comparePictures(query, signal);
  const read = new Map();
  const empty = note("No run of these cells is done yet.");
  let shown = "";
  async function load(ids, labels) {
    for (const id of ids) {
      if (!read.has(id)) read.set(id, await getJob(id, signal));
    }
    await pictures.show(ids.map((id) => read.get(id)), labels);
  }
  return (number, cells, names) => {
    const done = cells.map((c) => [names.get(c.cell), c.runs.find((r) => r.state === "done")]).filter(([, r]) => r);
    const ids = done.map(([, r]) => r.job);
    if (ids.length > 0 && ids.join() !== shown) {
      shown = ids.join();
      load(ids, done.map(([name]) => name)).catch((error) => { if (!signal.aborted) failed(error.message); });
    }
    return [h("h2", "Pictures of the shown cells"), ids.length > 0 ? pictures.element : empty];
  };
}

/// Runs that need a look: failed ones, and those whose times were disturbed.
function doubtfulRuns(answers) {
  const rows = answers.cells.flatMap((cell) => cell.runs
    .filter((r) => r.tainted || r.state === "failed")
    .map((r) => [h("a", { href: `#/job/${r.job}` }, r.name), cell.text, r.state, r.tainted ?? ""]));
  return rows.length > 0 && h("details", h("summary", `${rows.length} runs to look at`),
    table(["Run", "Settings", "State", "Disturbed by"], rows));
}

export async function show(main, { params, query, signal }) {
  const { id } = params;
  document.head.append(style);
  if (!query.has("mode")) query.set("mode", "crops");  // side by side, as cells are compared
  const heading = h("h1");
  const state = badge();
  const bar = progressBar("Share of the runs");
  const refusal = h("div");
  const say = (text) => replace(refusal, text && problem(text));
  const about = h("p");
  const runs = h("div");
  const source = h("section");
  const act = (question, content, yes, call, then) => async () => {
    say("");
    if (await ask(question, content, yes, call)) then();
  };
  const cancel = button("Cancel sweep", act("Cancel this sweep?", "What its runs have rendered so far is kept.",
    "Cancel sweep", () => cancelSweep(id), () => step().catch((e) => say(e.message))), { className: "danger" });
  const remove = button("Delete …", act("Delete this sweep?", "This also deletes all its jobs, with their pictures, curves and reports.",
    "Delete for good", () => removeSweep(id), () => { location.hash = "#/sweeps"; }), { className: "danger" });
  const view = answersView(query, () => remember(query), cellPictures(query, signal, say));
  main.append(
    h("div.title", heading, state.element, bar.element, h("div.tools.actions",
      // Above what is drawn late: a link that a picture moves is missed.
      h("a", { href: `#/?sweep=${id}` }, "its runs"), h("a", { href: tableUrl(id), download: `${id}.csv` }, "table.csv"),
      cancel, remove)),
    h("p.id", id), refusal, about, view.element, runs, source);

  let took = 0;
  async function step() {
    const asked = performance.now();
    const [sweep, answers] = await Promise.all([getSweep(id, signal), getAnswers(id, signal)]);
    took = performance.now() - asked;
    const over = isOver(sweep.state);
    setText(heading, sweep.label || "Sweep");
    document.title = `${sweep.label || "Sweep"} · Lacuna`;
    state.set(sweep.state);
    bar.set(over ? "done" : "running", over ? null : { share: sweep.share, remaining_seconds: null });
    cancel.hidden = over;
    remove.hidden = !over;
    setText(about, `${summary(answers)}. Created ${when(sweep.created)}.`);
    view.show(answers);
    replace(runs, doubtfulRuns(answers));
    if (!source.firstChild) {
      const command = sweepCurl(withoutNulls(sweep.spec));
      source.append(h("details", h("summary", "Sweep file"), h("pre.tall", { tabIndex: 0 }, prettyJob(sweep.spec)),
        h("pre.tall", { tabIndex: 0 }, command), copyButton(() => command)));
    }
    return !over;
  }
  await poll(step, () => Math.max(everyMs, took / share), signal);
}
