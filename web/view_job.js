// One job: its picture, its error against time, its report, and its files; live while it runs.
import { change, curlLine, fileUrl, getJob, getPart, getText, jobPath, listen, pollOn, remove, soon, tell }
  from "./api.js";
import { curveTable, parseCurve } from "./curve.js";
import { curvePanel } from "./curve_panel.js";
import { action, ask, button, copyButton, facts, h, problem, replace, small, update, warning } from "./dom.js";
import { badge, bytes, currentError, duration, integratorName, isTerminal, jobTitle, number, prettyJob, progressBar,
  seconds, states, when, withoutNulls } from "./format.js";
import { jobPictures } from "./job_pictures.js";
import { reportParts } from "./report.js";
import { chosen } from "./view_jobs.js";
import { noViewer } from "./viewer.js";

const refreshMs = 2000;
const logTail = 1 << 16;  // shown bytes of a long log

// A camera defined in the job, in one line: "at 1, 2, 3 to 0, 0, 0, 45°".
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
  ["Render time", progress && seconds(progress.seconds)],
  ["CPU time / threads", progress && seconds(progress.cpu_seconds)],
  ["Iterations", progress && number(progress.iteration)],
  ["Error", currentError(progress)],
  ["Remaining", progress && !isTerminal(state.state) ? duration(progress.remaining_seconds) : ""],
]);

const fileList = (id, files) => h("ul.files", files.map(({ name, bytes: size }) => h("li",
  h("a", { href: fileUrl(id, name), download: `${id}-${name}` }, name), " ", h("span.muted", bytes(size)))));

function jobSource(id, job) {
  const command = curlLine("jobs", withoutNulls(job));
  return h("div.columns",
    h("section", h("h2", "Job file"), h("pre.tall", { tabIndex: 0 }, prettyJob(job))),
    h("section", h("h2", "Repeat it"), h("pre.tall", { tabIndex: 0 }, command),
      h("p", copyButton(command), " ", h("a", { href: `#/new?from=${id}` }, "Change it and post it here"))));
}

/// A budget twice as large: every limit doubled, an error to reach halved.
export const doubled = (budget) => Object.fromEntries(Object.entries(budget)
  .filter(([, limit]) => limit !== null)
  .map(([key, limit]) => [key, typeof limit === "number" ? 2 * limit : { ...limit, target: limit.target / 2 }]));

function askBudget(id, { budget }) {
  const field = h("input", { value: JSON.stringify(doubled(budget)), spellcheck: false, required: true });
  return ask("Extend this job", [
    h("p", "The job continues where it stopped. Enter the new total budget; no limit may be smaller than before:"),
    h("label", h("span", "Budget "), field)], "Extend",
  () => tell(id, "extend", JSON.stringify({ budget: JSON.parse(field.value) })));
}

/// A button for each action on a job. Calls `changed()` or `gone()` afterwards, `say(text)` if it is refused.
function actionTools({ id, job, priority, state }, { changed, gone, say }) {
  const act = (call, then = changed) => action(call, then, say);
  const danger = { className: "danger" };
  const by = (step) => act(() => change(id, { priority: priority + step }));
  const tools = {
    priority: () => h("span.tools", h("output.muted", `priority ${priority}`),
      small("−", by(-1), "Lower priority"), small("+", by(1), "Higher priority")),
    hold: () => button("Hold", act(() => change(id, { held: true }))),
    release: () => button("Release", act(() => change(id, { held: false }))),
    retry: () => button("Retry", act(() => tell(id, "retry"))),
    extend: () => button("Extend …", act(() => askBudget(id, job))),
    cancel: () => button("Cancel job", act(() => ask("Cancel this job?", "What it has rendered so far is kept.",
      "Cancel job", () => tell(id, "cancel"))), danger),
    delete: () => button("Delete …", act(() => ask("Delete this job?",
      "This also deletes its pictures, curve and report.", "Delete for good", () => remove(id)), gone), danger),
  };
  const { actions } = states[state.state];
  return h("div.tools.actions", { role: "group", "aria-label": "What can be done" },
    Object.keys(tools).filter((name) => actions.includes(name)).map((name) => tools[name]()));
}

/// The end of a job's log, followed while it is open. `show(size)`: the size of log.txt, if any.
function logView(id, signal) {
  const text = h("pre.tall", { tabIndex: 0, "aria-label": "Log" });
  const note = h("p.note");
  const element = h("details", { ontoggle: read }, h("summary", "Log"), text, note);
  let size = 0;
  let shown = 0;

  async function read() {
    if (!element.open || size === shown) return;
    const end = size;
    shown = end;
    const begin = Math.max(0, end - logTail);
    try {
      const { data } = await getPart(id, "log.txt", begin, end - begin, signal);
      if (end !== shown) return;
      const lines = new TextDecoder().decode(data);
      const atEnd = text.scrollTop + text.clientHeight >= text.scrollHeight - 4;
      // A part from the middle of the file begins within a line, perhaps within a character.
      update(text, begin > 0 ? lines.slice(lines.indexOf("\n") + 1) : lines);
      if (atEnd) text.scrollTop = text.scrollHeight;
      update(note, begin > 0 && `The last part of it, from ${bytes(begin)} on. `,
        h("a", { href: fileUrl(id, "log.txt") }, "The whole log"));
    } catch (error) {
      shown = 0;
      if (!signal.aborted) update(note, error.message);
    }
  }

  return {
    element,
    show(next) {
      element.hidden = next === undefined;
      size = next ?? 0;
      read();
    },
  };
}

/// The caption of a picture that the viewer cannot show.
function describe({ image, drawable, state }) {
  const why = isTerminal(state.state)
    ? "This job has no layers.json (written by newer versions); its tone-mapped image.png is shown."
    : "Preview: the latest tone-mapped image.png. Pixel values are available when the job ends.";
  return { alt: "The picture", caption: image && h("span.muted", drawable ? why : noViewer) };
}

/// The parts of the page that follow the job; `read(job)` shows its files, rereading those that changed in size or
/// state.
function page(id, query, signal) {
  const [title, notes] = [h("div.title"), h("div.notes")];
  const [refusal, facts, files, report, source, curve, strategies] = Array.from({ length: 7 }, () => h("div"));
  const log = logView(id, signal);
  const pictures = jobPictures(query, signal, describe);
  const panel = curvePanel(query);
  const rows = h("details", h("summary", "Curve as a table"), curve);
  const versions = {};
  let pyramid = null;

  async function showPicture(job) {
    const layers = await pictures.show([{ ...job, name: jobTitle(job.job) }]);
    // Most jobs have no strategies.
    if (layers === null || !(pyramid || layers.names.some((name) => name.includes(".")))) return;
    pyramid ??= (await import("./strategies.js")).strategies(query, signal, pictures.open);
    replace(strategies, pyramid.element);
    pyramid.show(layers);
  }

  /// The text of a file, "" if it is missing; null if it is unchanged.
  async function news(name, { state, files: all }) {
    const file = all.find((f) => f.name === name);
    const version = `${state.state} ${file?.bytes}`;
    if (versions[name] === version) return null;
    const text = file ? await getText(id, name, signal) : "";
    versions[name] = version;
    return text;
  }

  const say = (text) => replace(refusal, text && problem(text));
  return {
    title, notes, facts, source, log, say,
    element: h("article", title, h("p.id", id), notes, refusal,
      h("div.columns", h("div", pictures.element, facts), h("div", h("h2", "Error"), panel.element, rows, files)),
      strategies, report, source, log.element),
    async read(job) {
      showPicture(job).catch((error) => { if (!signal.aborted) say(error.message); });
      log.show(job.files.find((f) => f.name === "log.txt")?.bytes);
      update(files, h("h2", "Files"), fileList(id, job.files));
      const table = await news("curve.csv", job);
      if (table !== null) {
        const points = parseCurve(table);
        panel.show([{ name: integratorName(job.job.integrator), rows: points }], job.progress?.error_metric);
        rows.hidden = points.length === 0;
        update(curve, curveTable(points));
      }
      const found = await news("report.json", job);
      if (found) replace(report, reportParts(JSON.parse(found)));
    },
  };
}

export async function show(main, { params, query, signal }) {
  const { id } = params;
  const view = page(id, query, signal);
  const changed = () => refreshSoon(0);
  const gone = () => {
    chosen.delete(id);
    location.hash = "#/";
  };
  let shown = null;
  let told = 0;  // events
  let stop;  // ends the event stream, while open

  function drawStatus() {
    const { job, state, progress } = shown;
    update(view.title, h("h1", jobTitle(job)), badge(state.state, state.phase),
      progressBar("Share of the budget", state.state, progress), actionTools(shown, { changed, gone, say: view.say }));
    update(view.notes, state.error && problem(state.error), state.obstacle && warning(`Waiting: ${state.obstacle}`),
      state.warnings?.map(warning));
    update(view.facts, jobFacts(shown));
    view.element.dataset.state = state.state;
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
    // An event that arrived meanwhile may be newer, and has requested the job again.
    if (told !== asked) shown = { ...shown, state: before.state, progress: before.progress };
    if (before === null) {
      view.log.element.open = shown.state.state === "failed";
      replace(main, view.element);
    }
    document.title = `${jobTitle(shown.job)} · Lacuna`;
    // The job file changes only when its budget does.
    if (JSON.stringify(before?.job) !== JSON.stringify(shown.job)) replace(view.source, jobSource(id, shown.job));
    drawStatus();
    await view.read(shown);
    const over = isTerminal(shown.state.state);
    if (over) rest();
    else follow();
    return !over;
  }

  const refreshSoon = soon(refresh, (error) => view.say(error.message), signal);
  const rest = () => { stop = stop?.(); };
  /// While the job waits or runs, also after it continues.
  function follow() {
    const on = (key, ms) => (value) => {
      told += 1;
      shown[key] = value;
      drawStatus();
      if (isTerminal(shown.state.state)) rest();  // the server ends the stream: do not reconnect
      refreshSoon(ms);
    };
    stop ??= listen(() => `${jobPath(id)}/events`, { state: on("state", 0), progress: on("progress", refreshMs) },
      () => pollOn(refresh, refreshMs, signal), signal);
  }

  await refresh();
}
