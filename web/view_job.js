// One job: its picture, its error against time, its report, and its files; live while it runs.
import { fileUrl, getJob, getText, jobPath, listen, poll, soon } from "./api.js";
import { parseCurve } from "./curve.js";
import { curvePanel } from "./curve_panel.js";
import { curveTable } from "./curve_table.js";
import { copyButton, facts, h, problem, replace, setText, warning } from "./dom.js";
import { effortView } from "./effort.js";
import { bytes, curlLine, duration, integratorName, jobTitle, number, prettyJob, seconds, when }
  from "./format.js";
import { jobActions } from "./job_actions.js";
import { jobPicture } from "./job_picture.js";
import { logView } from "./log_view.js";
import { reportView } from "./report.js";
import { badge, currentError, isTerminal, progressBar } from "./status.js";
import { chosen } from "./view_jobs.js";

const refreshMs = 2000;

// A camera of the job's own in one line: "at 1, 2, 3 to 0, 0, 0, 45°".
const cameraText = (camera) => (camera && typeof camera === "object"
  ? `at ${camera.position.join(", ")} to ${camera.target.join(", ")}, ${camera.fov}°`
  : camera);

const jobFacts = ({ job, state, progress, sweep }) => facts([
  ["Sweep", sweep && h("a", { href: `#/sweep/${sweep}` }, sweep)],
  ["Scene", job.scene],
  ["Camera", cameraText(job.camera)],
  ["Integrator", integratorName(job.integrator)],
  ["Resolution", job.resolution?.join(" × ")],
  ["Reference", job.reference],
  ["Seed", job.seed],
  ["Created", when(state.created)],
  ["Started", when(state.started)],
  ["Finished", when(state.finished)],
  ["Runs in", state.place],
  ["Attempts", state.attempts > 1 ? number(state.attempts) : ""],
  ["Exit code", state.exit_code > 0 ? state.exit_code : ""],
  ...(progress ? [
    ["Render time", seconds(progress.seconds)],
    ["CPU time / threads", seconds(progress.cpu_seconds)],
    ["Iterations", number(progress.iteration)],
    ["Error", currentError(progress)],
    ["Remaining", isTerminal(state.state) ? "" : duration(progress.remaining_seconds)],
  ] : []),
]);

const fileList = (id, files) => h("ul.files", files.map((file) => h("li",
  h("a", { href: fileUrl(id, file.name), download: `${id}-${file.name}` }, file.name),
  " ", h("span.muted", bytes(file.bytes)))));

function jobSource(id, job) {
  const command = curlLine(job);
  return h("div.columns",
    h("section", h("h2", "Job file"), h("pre.tall", { tabIndex: 0 }, prettyJob(job))),
    h("section", h("h2", "Repeat it"), h("pre.tall", { tabIndex: 0 }, command),
      h("p", copyButton(() => command), " ",
        h("a", { href: `#/new?from=${id}` }, "Change it and post it here"))));
}

/// The page, and those parts of it that follow the job.
function page(id, query, signal) {
  const view = {
    heading: h("h1"), notes: h("div.notes"), refusal: h("div"), facts: h("div"), files: h("section"),
    report: h("section"), source: h("div"), state: badge(), bar: progressBar("Share of the budget"), log: logView(id, signal),
    image: jobPicture(id, query, signal), panel: curvePanel(query, signal),
    rows: h("details", h("summary", "Curve as a table")),
    say: (text) => replace(view.refusal, text && problem(text)),
  };
  view.title = h("div.title", view.heading, view.state.element, view.bar.element);
  view.element = h("article", view.title, h("p.id", id), view.notes, view.refusal,
    h("div.columns", h("div", view.image.element, view.facts),
      h("div", h("h2", "Error"), view.panel.element, view.rows, view.files)),
    view.image.strategies, view.report, view.source, view.log.element);
  return view;
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
      .catch((error) => { if (!signal.aborted) view.say(error.message); });
    view.log.update(files["log.txt"]?.bytes ?? null);
    replace(view.files, h("h2", "Files"), fileList(id, shown.files));
    if (changed("curve.csv") || !files["curve.csv"]) {
      const curve = files["curve.csv"] ? parseCurve(await getText(id, "curve.csv", signal)) : [];
      view.panel.show([{ name: integratorName(shown.job.integrator), rows: curve }],
        shown.progress?.error_metric);
      view.rows.hidden = curve.length === 0;
      view.rows.replaceChildren(view.rows.firstChild, curveTable(curve));
    }
    if (changed("report.json")) {
      const report = JSON.parse(await getText(id, "report.json", signal));
      // Few jobs have a race: its code is read with the first.
      const race = report.race && (await import("./race.js")).raceView(report.race);
      replace(view.report, race && [h("h2", "The race"), race],
        h("h2", "Time and rays"), effortView(report),
        h("h2", "Report"), reportView(report));
    }
    versions = next;
  };
}

export async function show(main, { params, query, signal }) {
  const { id } = params;
  const view = page(id, query, signal);
  const actions = jobActions(id, {
    changed: () => refreshSoon(0),
    gone: () => {
      chosen.delete(id);
      location.hash = "#/";
    },
    failed: view.say,
  });
  view.title.append(actions.element);
  let shown = null;
  let told = 0;  // events
  const drawFiles = fileReader(id, view, signal);
  let stop = null;  // ends the listening, while there is any

  function drawStatus() {
    const { state, progress } = shown;
    view.state.set(state.state, state.phase);
    view.bar.set(state.state, progress);
    actions.show(shown);
    replace(view.notes, state.error && problem(state.error), state.obstacle && warning(`It waits: ${state.obstacle}`),
      state.warnings?.map(warning));
    replace(view.facts, jobFacts(shown));
    view.element.dataset.state = state.state;
  }

  /// The job file changes only when its budget does.
  function drawJob({ job }) {
    document.title = `${jobTitle(job)} · Lacuna`;
    setText(view.heading, jobTitle(job));
    replace(view.source, jobSource(id, job));
  }

  async function refresh() {
    const before = shown;
    const asked = told;
    shown = await getJob(id, signal);
    if (!shown.job) {  // its folder is damaged
      document.title = `${id} · Lacuna`;
      main.replaceChildren(h("article", h("h1", id), problem(shown.state.error)));
      return false;
    }
    // An event that came meanwhile may be newer, and has asked for the job again.
    if (told !== asked) shown = { ...shown, state: before.state, progress: before.progress };
    if (before === null) {
      view.log.element.open = shown.state.state === "failed";
      main.replaceChildren(view.element);
    }
    if (JSON.stringify(before?.job) !== JSON.stringify(shown.job)) drawJob(shown);
    drawStatus();
    await drawFiles(shown);
    const over = isTerminal(shown.state.state);
    if (over) rest();
    else follow();
    return !over;
  }

  const refreshSoon = soon(refresh, (error) => view.say(error.message), signal);
  function rest() {
    stop?.();
    stop = null;
  }
  /// From when the job waits or runs until it is over, also when it goes on after that.
  function follow() {
    stop ??= listen(() => `${jobPath(id)}/events`, {
      state(state) {
        told += 1;
        shown.state = state;
        drawStatus();
        if (isTerminal(state.state)) rest();  // the server ends the stream: do not ask for it again
        refreshSoon(0);
      },
      progress(progress) {
        told += 1;
        shown.progress = progress;
        drawStatus();
        refreshSoon(refreshMs);
      },
    }, () => pollOn(refresh, refreshMs, signal), signal);
  }

  await refresh();
}
