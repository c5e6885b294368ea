// One job: its picture, its error against time, its report, and its files; live while it runs.
import { canCancel, cancelJob, fileUrl, getJob, getText, isTerminal, listen, poll } from "./api.js";
import { parseCurve } from "./curve.js";
import { curveTable } from "./curve_table.js";
import { curvePanel } from "./curve_panel.js";
import { copyButton, h, setText } from "./dom.js";
import { effortView } from "./effort.js";
import { bytes, curlLine, duration, integratorName, jobTitle, number, prettyJob, seconds, when }
  from "./format.js";
import { jobPicture } from "./job_picture.js";
import { logView } from "./log_view.js";
import { reportView } from "./report.js";
import { badge, currentError, progressBar } from "./status.js";

const refreshMs = 2000;

/// Names and values, side by side; values that are empty are left out.
const facts = (pairs) => h("dl", { className: "facts" }, pairs
  .filter(([, value]) => value !== "" && value !== null && value !== undefined)
  .map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value))));

function settingFacts(job) {
  return facts([
    ["Scene", job.scene],
    ["Camera", job.camera],
    ["Integrator", integratorName(job.integrator)],
    ["Resolution", job.resolution && `${job.resolution[0]} × ${job.resolution[1]}`],
    ["Reference", job.reference],
    ["Seed", job.seed === undefined ? "" : String(job.seed)],
  ]);
}

function stateFacts(state, progress) {
  return facts([
    ["Created", when(state.created)],
    ["Started", when(state.started)],
    ["Finished", when(state.finished)],
    ["Attempts", state.attempts > 1 ? number(state.attempts) : ""],
    ["Exit code", state.exit_code > 0 ? String(state.exit_code) : ""],
    ["Render time", progress ? seconds(progress.seconds) : ""],
    ["CPU time / threads", progress ? seconds(progress.cpu_seconds) : ""],
    ["Iterations", progress ? number(progress.iteration) : ""],
    ["Error", currentError(progress)],
    ["Remaining", progress && !isTerminal(state.state) ? duration(progress.remaining_seconds) : ""],
  ]);
}

function messages(state) {
  return [
    state.error && h("p", { className: "problem", role: "alert" }, state.error),
    (state.warnings ?? []).map((text) => h("p", { className: "warning" }, text)),
  ];
}

function fileList(id, files) {
  return h("ul", { className: "files" }, files.map((file) => h("li", {},
    h("a", { href: fileUrl(id, file.name), download: `${id}-${file.name}` }, file.name),
    " ", h("span", { className: "muted" }, bytes(file.bytes)))));
}

function jobSource(id, job) {
  const command = curlLine(job);
  return h("div", { className: "columns" },
    h("section", {},
      h("h2", {}, "Job file"),
      h("pre", { tabIndex: 0, className: "tall" }, prettyJob(job))),
    h("section", {},
      h("h2", {}, "Repeat it"),
      h("pre", { tabIndex: 0, className: "tall" }, command),
      h("p", {}, copyButton(() => command), " ",
        h("a", { href: `#/new?from=${id}` }, "Change it and post it here"))));
}

/// The parts of the page that follow the job, and `set...` to bring them up to date.
function page(id, query, signal) {
  const heading = h("h1");
  const state = badge();
  const bar = progressBar("Share of the budget");
  const cancel = h("button", { type: "button", className: "danger" }, "Cancel job");
  const notes = h("div", { className: "notes" });
  const settings = h("div");
  const progressFacts = h("div");
  const remember = () => history.replaceState(null, "", `#/job/${id}?${query}`);
  const image = jobPicture(id, query, remember, signal);
  const panel = curvePanel(query, remember, signal);
  const rows = h("details", {}, h("summary", {}, "Curve as a table"));
  const report = h("section", { hidden: true });
  const files = h("section");
  const source = h("div", { className: "source" });
  const log = logView(id, signal);
  const element = h("article", {},
    h("div", { className: "title" }, heading, state.element, bar.element, cancel),
    h("p", { className: "id" }, id), notes,
    h("div", { className: "columns" },
      h("div", {}, image.element, settings, progressFacts),
      h("div", {}, h("h2", {}, "Error"), panel.element, rows, files)),
    report, source, log.element);
  return {
    element, heading, state, bar, cancel, notes, settings, progressFacts, image, panel, rows, report,
    files, source, log,
  };
}

/// A function that shows a job's files and reads again those whose size or state changed.
function fileReader(id, view, signal) {
  let versions = {};
  return async (shown) => {
    const files = Object.fromEntries(shown.files.map((f) => [f.name, f]));
    const next = Object.fromEntries(shown.files.map((f) => [f.name, `${shown.state.state} ${f.bytes}`]));
    const changed = (name) => files[name] && next[name] !== versions[name];
    // image.png is written after the layers, and unlike theirs its size changes with its content.
    view.image.update(files, next["image.png"] ?? "", jobTitle(shown.job), isTerminal(shown.state.state))
      .catch((error) => { if (!signal.aborted) setText(view.progressFacts, error.message); });
    view.log.update(files["log.txt"]?.bytes ?? null);
    view.files.replaceChildren(h("h2", {}, "Files"), fileList(id, shown.files));
    if (changed("curve.csv") || !files["curve.csv"]) {
      const curve = files["curve.csv"] ? parseCurve(await getText(id, "curve.csv", signal)) : [];
      view.panel.show([{ name: integratorName(shown.job.integrator), rows: curve }],
        shown.progress?.error_metric);
      view.rows.hidden = curve.length === 0;
      view.rows.replaceChildren(view.rows.firstChild, curveTable(curve));
    }
    if (changed("report.json")) {
      const report = JSON.parse(await getText(id, "report.json", signal));
      view.report.replaceChildren(h("h2", {}, "Where time and rays went"), effortView(report),
        h("h2", {}, "Report"), reportView(report));
      view.report.hidden = false;
    }
    versions = next;
  };
}

export async function show(main, { params, query, signal }) {
  const { id } = params;
  const view = page(id, query, signal);
  let shown = null;
  const drawFiles = fileReader(id, view, signal);
  let reading = Promise.resolve();
  let waiting = false;
  let stop = () => {};

  function drawStatus() {
    const { state, progress } = shown;
    view.state.set(state.state, state.phase);
    view.bar.set(state.state, progress);
    view.cancel.hidden = !canCancel(state.state);
    view.notes.replaceChildren(...messages(state).flat().filter(Boolean));
    view.progressFacts.replaceChildren(stateFacts(state, progress));
    view.element.setAttribute("data-state", state.state);
  }

  function drawOnce() {
    const { job } = shown;
    document.title = `${jobTitle(job)} · Lacuna`;
    setText(view.heading, jobTitle(job));
    view.settings.replaceChildren(settingFacts(job));
    view.source.replaceChildren(jobSource(id, job));
    view.log.element.open = shown.state.state === "failed";
    main.replaceChildren(view.element);
  }

  async function refresh() {
    const first = shown === null;
    shown = await getJob(id, signal);
    if (first) drawOnce();
    drawStatus();
    await drawFiles(shown);
    const over = isTerminal(shown.state.state);
    if (over) stop();
    return !over;
  }

  /// Files follow events at leisure: one reading after the other, however many events come.
  function refreshSoon(ms) {
    if (waiting) return;
    waiting = true;
    reading = reading
      .then(() => new Promise((resolve) => { setTimeout(resolve, ms); }))
      .then(() => {
        waiting = false;
        return signal.aborted || refresh();
      })
      .catch((error) => { if (!signal.aborted) setText(view.progressFacts, error.message); });
  }

  view.cancel.onclick = async () => {
    if (!window.confirm("Cancel this job? What it has rendered so far is kept.")) return;
    view.cancel.disabled = true;
    await cancelJob(id).catch((error) => view.notes.append(
      h("p", { className: "problem", role: "alert" }, error.message)));
    view.cancel.disabled = false;
    refreshSoon(0);
  };

  if (!await refresh()) return;
  stop = listen(id, {
    state(state) {
      shown.state = state;
      drawStatus();
      if (isTerminal(state.state)) stop();  // the server ends the stream: do not ask for it again
      refreshSoon(0);
    },
    progress(progress) {
      shown.progress = progress;
      drawStatus();
      refreshSoon(refreshMs);
    },
    lost: () => poll(refresh, refreshMs, signal),
  }, signal);
}
