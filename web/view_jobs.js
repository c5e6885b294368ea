// The live list of jobs, in pages, with a filter and a selection of jobs to compare.
import { fileUrl, curlLine, getHealth, getJobs, getScenes, listen, pollOn, queryOf, soon } from "./api.js";
import { button, emptyPlace, h, note, patch, problem, remember, select, small, update, warning } from "./dom.js";
import { badge, currentError, firstJob, integratorName, isTerminal, jobTitle, progressBar, states, when }
  from "./format.js";

const pageSize = 100;
const pollMs = 2000;
const soonMs = 500;
const typingMs = 150;
const thumbSeconds = 10;  // of rendering, after which a running job's thumbnail is reloaded
/// The jobs to compare: the selection is kept across pages and views.
export const chosen = new Set();

const noJobs = (scenes) => [
  emptyPlace("No jobs yet", ["Post the first from a shell, or from ", h("a", { href: "#/new" }, "New job"), ":"],
    curlLine("jobs", firstJob(scenes))),
  scenes.length === 0 && problem("The server has no scenes: start it with LACUNA_SCENES set to a folder of scenes."),
];

/// A job's state and obstacle, which change the page, the counts and the service's health.
const standing = (job) => `${job.state} ${job.obstacle ? "waits" : ""}`;

// The narrow layout shows rows as grids, for which browsers drop the table semantics.
const cell = (className, ...children) => h("td", { role: "cell", className }, children);

/// A thumbnail of a job, loaded when visible; it changes with the state, and with time while it runs.
function thumbnail({ id, state, picture, progress }) {
  const age = isTerminal(state) ? "" : Math.floor((progress?.seconds ?? 0) / thumbSeconds);
  return h("span.thumb", picture && h("img", { loading: "lazy", decoding: "async", alt: "",
    src: fileUrl(id, "image.png", `${state} ${age}`) }));
}

function jobRow(job, onchoose) {
  const { id, label, scene, state, progress } = job;
  const name = jobTitle(job);
  const href = `#/job/${id}`;
  return h("tr", { id: `row-${id}`, role: "row", "data-job": id },
    cell("choose", h("label", h("input", { type: "checkbox", ariaLabel: `Compare ${name}, ${id}`,
      checked: chosen.has(id), onchange: (event) => onchoose(id, event.target.checked) }))),
    cell("picture-cell", h("a", { href, tabIndex: -1, "aria-hidden": "true" }, thumbnail(job))),
    h("th.name", { role: "rowheader", scope: "row" }, h("a", { href }, name),
      h("span.detail", label ? `${scene} · ${id}` : id), h("span.reason", job.error || job.obstacle)),
    cell("integrator", integratorName(job.integrator)),
    cell("state", badge(state, job.phase)),
    cell("progress-cell", progressBar("Share of the budget", state, progress)),
    cell("error", currentError(progress)),
    cell("created", h("time", { dateTime: job.created }, when(job.created))));
}

const heads = ["Job", "Integrator", "State", "Progress", "Error", "Created"];

const jobTable = (jobs, onchoose) => h("table.jobs", { role: "table" },
  h("thead", h("tr", h("td.choose"), h("td.picture-cell"), heads.map((text) => h("th", { scope: "col" }, text)))),
  h("tbody", { role: "rowgroup" }, jobs.map((job) => jobRow(job, onchoose))));

const choiceTools = (redraw) => h("span.tools.choose-tools",
  chosen.size > 0 && button("Clear the selection", () => {
    chosen.clear();
    redraw();
  }),
  button(chosen.size > 0 ? `Compare (${chosen.size})` : "Compare",
    () => { location.hash = `#/compare?jobs=${[...chosen].join(",")}`; }, { disabled: chosen.size < 2 }));

/// The filter of the list: `wanted` is {label, state, sweep}, `changed(values)` changes it.
function filterTools(wanted, counts, changed) {
  const options = Object.keys(states).map((name) => ({ key: name, label: `${name} (${counts[name] ?? 0})` }));
  return [
    h("input", { type: "search", value: wanted.label, placeholder: "Filter: label, scene, integrator or id",
      "aria-label": "Filter the jobs", oninput: (event) => changed({ label: event.target.value }) }),
    select([{ key: "", label: "all states" }, ...options], wanted.state, (state) => changed({ state }),
      { "aria-label": "State" }),
    wanted.sweep && small("of one sweep ×", () => changed({ sweep: "" })),
  ];
}

const first = { cursor: "", from: 0 };

/// Returns a function that builds the navigation to the previous and next page; `go(place)` opens one.
function pager(go) {
  let back = [];  // the previous pages
  return ({ here, jobs, total, next }) => {
    if (!here.cursor) back = [];
    const on = () => {
      back.push(here);
      go({ cursor: next, from: here.from + jobs.length });
    };
    return h("nav.tools.pager", { "aria-label": "Pages", hidden: !here.cursor && next === null },
      button("‹ Newer", () => go(back.pop() ?? first), { disabled: !here.cursor }),
      h("output.muted", `${jobs.length && here.from + 1}–${here.from + jobs.length} of ${total}`),
      button("Older ›", on, { disabled: next === null }));
  };
}

/// The filter and page in the URL.
function addressed(query) {
  const given = (key) => query.get(key) ?? "";
  const state = given("state") in states ? given("state") : "";
  return { wanted: { label: given("label"), state, sweep: given("sweep") },
    place: { cursor: given("cursor"), from: Number(given("from")) || 0 } };
}

export async function show(main, { query, signal }) {
  document.title = "Jobs · Lacuna";
  update(main, h("h1", "Jobs"));
  let { wanted, place } = addressed(query);
  let found = null;  // the page that begins `here`, from the service, and the `obstacle` of all jobs
  let scenes = null;  // read once there is no job
  const known = new Map();  // the standing of every job in an event
  let asked = 0;

  const filter = () => ({ ...wanted, label: wanted.label.trim() });
  /// The URL contains what differs from the initial view.
  function go(next, ms) {
    place = next;
    remember(queryOf({ ...filter(), ...place }));
    listSoon(ms);
  }
  const pages = pager((next) => {
    go(next, 0);
    main.scrollIntoView();
  });
  function changed(values) {
    wanted = { ...wanted, ...values };
    go(first, typingMs);
  }
  function onchoose(id, on) {
    chosen[on ? "add" : "delete"](id);
    draw();
  }

  function draw(trouble = "") {
    const { jobs, total, counts, obstacle } = found;
    const all = Object.values(counts).reduce((sum, n) => sum + n, 0);
    const filtered = Object.values(filter()).some((value) => value !== "");
    const none = all > 0 || filtered ? note("No job matches the filter.") : noJobs(scenes);
    update(main, h("h1", "Jobs"), h("div", obstacle && warning(`Jobs wait: ${obstacle}`)),
      h("div.tools", { role: "search", hidden: all === 0 && !filtered }, filterTools(wanted, counts, changed),
        h("output.muted", trouble || (filtered ? `${total} of ${all}` : `${all} jobs`)), choiceTools(draw)),
      h("div", total > 0 ? jobTable(jobs, onchoose) : none),
      pages(found));
  }

  /// Requests the page; drops a response if a newer request was sent.
  async function list() {
    asked += 1;
    const mine = asked;
    const here = place;
    const [answer, health] = await Promise.all([
      getJobs({ ...filter(), cursor: here.cursor, limit: pageSize }, signal), getHealth(signal)]);
    if (answer.total === 0) scenes ??= await getScenes(signal);
    if (mine !== asked) return;
    found = { ...answer, here, obstacle: health.obstacle };
    for (const job of found.jobs) known.set(job.id, standing(job));
    draw();
  }

  const listSoon = soon(list, (error) => draw(error.message), signal);

  await list();
  listen(() => `/api/events?after=${encodeURIComponent(found.last_event)}`, {
    job(entry, id) {
      found.last_event = id || found.last_event;
      const at = found.jobs.findIndex((job) => job.id === entry.id);
      if (at >= 0) {
        found.jobs[at] = entry;
        patch(document.getElementById(`row-${entry.id}`), jobRow(entry, onchoose));
      }
      // The page's entries and the counts change only with the jobs' states.
      if (known.get(entry.id) !== standing(entry)) listSoon(soonMs);
      known.set(entry.id, standing(entry));
    },
    removed({ id }, event) {
      found.last_event = event || found.last_event;
      known.delete(id);
      if (chosen.delete(id)) draw();
      listSoon(soonMs);
    },
    reset: () => listSoon(soonMs),
  }, () => pollOn(list, pollMs, signal), signal);
}
