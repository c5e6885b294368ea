// The list of jobs, live, a page at a time, with a filter and a choice of jobs to compare.
import { getJobs, getScenes, poll } from "./api.js";
import { copyButton, h, setText } from "./dom.js";
import { curlLine, integratorName, jobTitle, when } from "./format.js";
import { jobFilter } from "./job_filter.js";
import { pager, pageSize } from "./pager.js";
import { badge, currentError, progressBar } from "./status.js";
import { thumbnails } from "./thumbnail.js";

const everyMs = 2000;

// The narrow layout shows rows as grids, and browsers then forget that they are a table's.
const cell = (className, ...children) => h("td", { role: "cell", className }, children);

/// A table row that follows its job; cells that did not change are left alone.
function makeRow(id, pictures, onchoose) {
  const choose = h("input", { type: "checkbox", onchange: () => onchoose(id, choose.checked) });
  const thumb = pictures.make();
  const title = h("a", { href: `#/job/${id}` });
  const detail = h("span", { className: "detail" });
  const reason = h("span", { className: "reason" });
  const integrator = cell("integrator");
  const state = badge();
  const progress = progressBar("Share of the budget");
  const error = cell("error");
  const created = h("time", {});
  const element = h("tr", { role: "row", "data-job": id },
    cell("choose", h("label", {}, choose)),
    cell("picture-cell", h("a", { href: title.href, tabIndex: -1, "aria-hidden": "true" }, thumb)),
    h("th", { role: "rowheader", scope: "row", className: "name" }, title, detail, reason),
    integrator,
    cell("state", state.element),
    cell("progress-cell", progress.element),
    error,
    cell("created", created));
  return {
    element,
    set(job, chosen) {
      const name = jobTitle(job);
      choose.setAttribute("aria-label", `Compare ${name}, ${id}`);
      choose.checked = chosen;
      setText(title, name);
      setText(detail, job.label ? `${job.scene} · ${id}` : id);
      setText(reason, job.error ?? "");
      setText(integrator, integratorName(job.integrator));
      state.set(job.state);
      progress.set(job.state, job.progress);
      setText(error, currentError(job.progress));
      setText(created, when(job.created));
      created.dateTime = job.created;
      pictures.update(thumb, job);
    },
  };
}

async function firstJob(signal) {
  const scenes = await getScenes(signal);
  const job = { scene: scenes[0] ?? "SCENE.glb", budget: { seconds: 30 }, reference: "auto" };
  const command = curlLine(job);
  return h("section", { className: "empty" },
    h("h2", {}, "No jobs yet"),
    h("p", {}, "Post the first from a shell, or from ", h("a", { href: "#/new" }, "New job"), ":"),
    h("pre", { tabIndex: 0 }, command), copyButton(() => command),
    scenes.length === 0 && h("p", { className: "problem" },
      "The server sees no scenes: start it with LACUNA_SCENES set to a folder that has some."));
}

const heads = ["Job", "Integrator", "State", "Progress", "Error", "Created"];

function jobTable() {
  const body = h("tbody", { role: "rowgroup" });
  const element = h("table", { role: "table", className: "jobs" },
    h("thead", {}, h("tr", {},
      h("td", { className: "choose" }), h("td", { className: "picture-cell" }),
      heads.map((text) => h("th", { scope: "col" }, text)))),
    body);
  return { element, body };
}

/// Puts `elements` into `body` in their order, moving only what is out of place.
function arrange(body, elements) {
  elements.forEach((element, i) => {
    if (body.children[i] !== element) body.insertBefore(element, body.children[i] ?? null);
  });
  while (body.children.length > elements.length) body.lastElementChild.remove();
}

export async function show(main, { query, signal }) {
  document.title = "Jobs · Lacuna";
  const chosen = new Set();
  const rows = new Map();
  const pictures = thumbnails(signal);
  let jobs = [];
  let empty = null;
  let page = Number(query.get("page")) || 1;

  /// The address holds what is not as at first.
  function remember() {
    const held = new URLSearchParams(Object.entries({ ...filter.values(), page: page > 1 ? page : "" })
      .filter(([, value]) => value !== ""));
    history.replaceState(null, "", held.size > 0 ? `#/?${held}` : "#/");
  }
  function go(next) {
    page = next;
    draw();
    remember();
  }
  const filter = jobFilter(query, () => go(1));
  const pages = pager((next) => {
    go(next);
    main.scrollIntoView();
  });
  const count = h("output", { className: "muted" });
  const compare = h("button", {
    type: "button",
    onclick: () => { location.hash = `#/compare?jobs=${[...chosen].join(",")}`; },
  });
  const { element, body } = jobTable();
  const tools = h("div", { className: "tools", role: "search" }, filter.elements, count, compare);
  const place = h("div");
  main.append(h("h1", {}, "Jobs"), tools, place, pages.element);

  function showCompare() {
    compare.disabled = chosen.size < 2;
    setText(compare, chosen.size > 0 ? `Compare (${chosen.size})` : "Compare");
  }

  function onchoose(id, on) {
    if (on) chosen.add(id);
    else chosen.delete(id);
    showCompare();
  }

  function rowOf(job) {
    if (!rows.has(job.id)) rows.set(job.id, makeRow(job.id, pictures, onchoose));
    const row = rows.get(job.id);
    row.set(job, chosen.has(job.id));
    return row.element;
  }

  function draw() {
    const found = filter.pick(jobs);
    page = pages.show(page, found.length);
    const visible = found.slice((page - 1) * pageSize, page * pageSize);
    for (const id of rows.keys()) if (!visible.some((job) => job.id === id)) rows.delete(id);
    arrange(body, visible.map(rowOf));
    tools.hidden = jobs.length === 0;
    setText(count, filter.active() ? `${found.length} of ${jobs.length}` : `${jobs.length} jobs`);
    const shown = jobs.length === 0 && empty ? empty : element;
    if (place.firstChild !== shown) place.replaceChildren(shown);
    showCompare();
  }

  await poll(async () => {
    jobs = await getJobs(signal);
    if (jobs.length === 0) empty ??= await firstJob(signal);
    draw();
  }, everyMs, signal);
}
