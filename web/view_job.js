// One job: its picture, its error against time, its report, and its files; live while it runs.
import { change, curlLine, fileUrl, getJob, getLog, getText, jobPath, listen, pollOn, remove, soon, tell }
  from "./api.js";
import { curveTable, parseCurve } from "./curve.js";
import { curvePanel } from "./curve_panel.js";
import { action, ask, button, copyButton, facts, h, problem, replace, sign, update, warning } from "./dom.js";
import { badge, bytes, currentError, duration, integratorName, isTerminal, jobTitle, number, prettyJob, progressBar,
  seconds, states, when, withoutNulls } from "./format.js";
import { jobPictures } from "./job_pictures.js";
import { reportParts } from "./report.js";
import { chosen } from "./view_jobs.js";
import { noViewer } from "./viewer.js";

const refreshMs = 2000;
const logTail = 1 << 16;  // bytes of a long log that are shown

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
  const command = curlLine("jobs", withoutNulls(job));
  return h("div.columns",
    h("section", h("h2", "Job file"), h("pre.tall", { tabIndex: 0 }, prettyJob(job))),
    h("section", h("h2", "Repeat it"), h("pre.tall", { tabIndex: 0 }, command),
      h("p", copyButton(command), " ",
        h("a", { href: `#/new?from=${id}` }, "Change it and post it here"))));
}

/// A budget twice as large: every limit doubled, an error to reach halved.
export const doubled = (budget) => Object.fromEntries(Object.entries(budget)
  .filter(([, limit]) => limit !== null)
  .map(([key, limit]) => [key, typeof limit === "number" ? 2 * limit : { ...limit, target: limit.target / 2 }]));

/// Asks for the whole new budget, as JSON.
function askBudget(id, { budget }) {
  const field = h("input", { value: JSON.stringify(doubled(budget)), spellcheck: false, required: true });
  return ask("Extend this job", [
    h("p", "The job continues where it stopped. Enter the new total budget; no limit may be smaller than before:"),
    h("label", h("span", "Budget "), field)], "Extend",
  () => tell(id, "extend", JSON.stringify({ budget: JSON.parse(field.value) })));
}

/// What can be done to a job (GET /api/jobs/ID) as it stands: a button each. `changed()` is called after it was
/// changed, `gone()` after it was deleted, and `say(text)` where the service refused.
function actionTools({ id, job, priority, state }, { changed, gone, say }) {
  const act = (call, then = changed) => action(call, then, say);
  const danger = { className: "danger" };
  const by = (step) => act(() => change(id, { priority: priority + step }));
  const tools = {
    priority: () => h("span.tools", h("output.muted", `priority ${priority}`),
      sign("−", "Lower priority", by(-1)), sign("+", "Higher priority", by(1))),
    hold: () => button("Hold", act(() => change(id, { held: true }))),
    release: () => button("Release", act(() => change(id, { held: false }))),
    retry: () => button("Retry", act(() => tell(id, "retry"))),
    extend: () => button("Extend …", act(() => askBudget(id, job))),
    cancel: () => button("Cancel job", act(() => ask("Cancel this job?", "What it has rendered so far is kept.",
      "Cancel job", () => tell(id, "cancel"))), danger),
    delete: () => button("Delete …", act(() => ask("Delete this job?", "This also deletes its pictures, curve and report.",
      "Delete for good", () => remove(id)), gone), danger),
  };
  const { actions } = states[state.state];
  return h("div.tools.actions", { role: "group", "aria-label": "What can be done" },
    Object.keys(tools).filter((name) => actions.includes(name)).map((name) => tools[name]()));
}

/// A job's log: its last part, followed while the job runs. `update(size)` says how large log.txt is; it is read only
/// while the log is open. undefined: there is none.
function logView(id, signal) {
  const text = h("pre.tall", { tabIndex: 0, "aria-label": "Log" });
  const note = h("p.note");
  const element = h("details", { hidden: true, ontoggle: follow }, h("summary", "Log"), text, note);
  let decoder;
  let begin = 0;
  let end = null;
  let size = 0;
  let reading = false;

  /// What comes after what is there; from the tail on if there is nothing, or a new, shorter log.
  async function readOn() {
    const anew = end === null || size < end;
    if (anew) [begin, end, decoder] = [Math.max(0, size - logTail), Math.max(0, size - logTail), new TextDecoder()];
    const { data, next } = await getLog(id, end, signal);
    end = next;
    size = Math.max(size, next);  // it may have grown since its size was told
    const more = decoder.decode(data, { stream: true });
    const atEnd = anew || text.scrollTop + text.clientHeight >= text.scrollHeight - 4;
    // A part that begins amid the file begins amid a line, perhaps amid a letter.
    if (anew) text.textContent = begin > 0 ? more.slice(more.indexOf("\n") + 1) : more;
    else text.append(more);
    if (atEnd) text.scrollTop = text.scrollHeight;
  }

  async function follow() {
    if (!element.open || reading) return;
    reading = true;
    try {
      while (size !== end && !signal.aborted) await readOn();
      update(note, begin > 0 && `The last part of it, from ${bytes(begin)} on. `,
        h("a", { href: fileUrl(id, "log.txt") }, "The whole log"));
    } catch (error) {
      end = null;
      if (!signal.aborted) update(note, error.message);
    }
    reading = false;
  }

  return {
    element,
    update(next) {
      element.hidden = next === undefined;
      size = next ?? 0;
      follow();
    },
  };
}

/// What is said of a picture that the viewer cannot show.
const describe = ({ image, drawable, state }) => ({ alt: "The picture", caption: image && h("span.muted", !drawable ? noViewer
  : isTerminal(state.state) ? "This job has no layers.json (written by newer versions); its tone-mapped image.png is shown."
    : "Preview: the latest tone-mapped image.png. Pixel values are available when the job ends.") });

/// The parts of the page that follow the job.
function page(id, query, signal) {
  const view = {
    title: h("div.title"), notes: h("div.notes"), refusal: h("div"), facts: h("div"), files: h("section"),
    strategies: h("div"), report: h("section"), source: h("div"), log: logView(id, signal),
    pictures: jobPictures(query, signal, describe), panel: curvePanel(query), curve: h("div"),
    say: (text) => replace(view.refusal, text && problem(text)),
  };
  view.rows = h("details", h("summary", "Curve as a table"), view.curve);
  view.element = h("article", view.title, h("p.id", id), view.notes, view.refusal,
    h("div.columns", h("div", view.pictures.element, view.facts),
      h("div", h("h2", "Error"), view.panel.element, view.rows, view.files)),
    view.strategies, view.report, view.source, view.log.element);
  return view;
}

/// A function that shows a job's picture, and below all else what strategies brought to it: most jobs have none.
function pictureReader(view, query, signal) {
  let pyramid = null;
  return async (shown) => {
    const layers = await view.pictures.show([{ ...shown, name: jobTitle(shown.job) }]);
    if (layers === null) return;
    view.strategies.hidden = !layers.names.some((name) => name.includes("."));
    if (view.strategies.hidden) return;
    pyramid ??= (await import("./strategies.js")).strategies(query, signal, view.pictures.open);
    view.strategies.replaceChildren(pyramid.element);
    pyramid.show(layers);
  };
}

/// A function that shows a job's files and reads again those whose size or state changed.
function fileReader(id, view, query, signal) {
  const showPicture = pictureReader(view, query, signal);
  let versions = {};
  return async (shown) => {
    const files = Object.fromEntries(shown.files.map((f) => [f.name, f]));
    const next = Object.fromEntries(shown.files.map((f) => [f.name, `${shown.state.state} ${f.bytes}`]));
    const changed = (name) => files[name] && next[name] !== versions[name];
    showPicture(shown).catch((error) => { if (!signal.aborted) view.say(error.message); });
    view.log.update(files["log.txt"]?.bytes);
    update(view.files, h("h2", "Files"), fileList(id, shown.files));
    if (changed("curve.csv") || !files["curve.csv"]) {
      const curve = files["curve.csv"] ? parseCurve(await getText(id, "curve.csv", signal)) : [];
      view.panel.show([{ name: integratorName(shown.job.integrator), rows: curve }],
        shown.progress?.error_metric);
      view.rows.hidden = curve.length === 0;
      update(view.curve, curveTable(curve));
    }
    if (changed("report.json")) {
      replace(view.report, reportParts(JSON.parse(await getText(id, "report.json", signal))));
    }
    versions = next;
  };
}

export async function show(main, { params, query, signal }) {
  const { id } = params;
  const view = page(id, query, signal);
  const handlers = {
    changed: () => refreshSoon(0),
    gone: () => {
      chosen.delete(id);
      location.hash = "#/";
    },
    say: view.say,
  };
  let shown = null;
  let told = 0;  // events
  const drawFiles = fileReader(id, view, query, signal);
  let stop = null;  // ends the listening, while there is any

  function drawStatus() {
    const { job, state, progress } = shown;
    update(view.title, h("h1", jobTitle(job)), badge(state.state, state.phase),
      progressBar("Share of the budget", state.state, progress), actionTools(shown, handlers));
    update(view.notes, state.error && problem(state.error), state.obstacle && warning(`It waits: ${state.obstacle}`),
      state.warnings?.map(warning));
    update(view.facts, jobFacts(shown));
    view.element.dataset.state = state.state;
  }

  /// The job file changes only when its budget does.
  function drawJob({ job }) {
    document.title = `${jobTitle(job)} · Lacuna`;
    replace(view.source, jobSource(id, job));
  }

  async function refresh() {
    const before = shown;
    const asked = told;
    shown = await getJob(id, signal);
    if (!shown.job) {  // its folder is damaged
      document.title = `${id} · Lacuna`;
      replace(main, h("article", h("h1", id), problem(shown.state.error)));
      return false;
    }
    // An event that came meanwhile may be newer, and has asked for the job again.
    if (told !== asked) shown = { ...shown, state: before.state, progress: before.progress };
    if (before === null) {
      view.log.element.open = shown.state.state === "failed";
      replace(main, view.element);
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
    const on = (key, ms) => (value) => {
      told += 1;
      shown[key] = value;
      drawStatus();
      if (isTerminal(shown.state.state)) rest();  // the server ends the stream: do not ask for it again
      refreshSoon(ms);
    };
    stop ??= listen(() => `${jobPath(id)}/events`, { state: on("state", 0), progress: on("progress", refreshMs) },
      () => pollOn(refresh, refreshMs, signal), signal);
  }

  await refresh();
}
