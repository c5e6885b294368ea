// The list of jobs, live, a page at a time, with a filter and a choice of jobs to compare.
import { getHealth, getJobs, getScenes, listen, pollOn, queryOf, soon } from "./api.js";
import { button, copyButton, h, note, problem, remember, replace, setText, warning } from "./dom.js";
import { curlLine, firstJob } from "./format.js";
import { jobFilter } from "./job_filter.js";
import { jobRow, jobTable } from "./job_row.js";
import { pager, pageSize } from "./pager.js";

const pollMs = 2000;
const soonMs = 500;
const typingMs = 150;

/// The jobs to compare: the choice survives turning pages and looking at jobs.
export const chosen = new Set();

async function noJobs(signal) {
  const scenes = await getScenes(signal);
  const command = curlLine(firstJob(scenes));
  return h("section.empty",
    h("h2", "No jobs yet"),
    h("p", "Post the first from a shell, or from ", h("a", { href: "#/new" }, "New job"), ":"),
    h("pre", { tabIndex: 0 }, command), copyButton(() => command),
    scenes.length === 0 && problem(
      "The server has no scenes: start it with LACUNA_SCENES set to a folder of scenes."));
}

/// What the page, the counts and the service's health change with.
const standing = (job) => `${job.state} ${job.obstacle ? "waits" : ""}`;

/// The buttons of the choice.
function choice(redraw) {
  const compare = button("Compare", () => { location.hash = `#/compare?jobs=${[...chosen].join(",")}`; });
  const clear = button("Clear the selection", () => {
    chosen.clear();
    redraw();
    show();
  });
  function show() {
    compare.disabled = chosen.size < 2;
    clear.hidden = chosen.size === 0;
    setText(compare, chosen.size > 0 ? `Compare (${chosen.size})` : "Compare");
  }
  show();
  return { element: h("span.tools.choose-tools", clear, compare), show };
}

export async function show(main, { query, signal }) {
  document.title = "Jobs · Lacuna";
  let rows = new Map();  // of the page that is shown, by id
  const known = new Map();  // the standing of every job that was told of
  let place = { cursor: query.get("cursor") ?? "", from: Number(query.get("from")) || 0 };
  let last = "";  // the last event that is known of
  let empty = null;
  let asked = 0;

  const filter = jobFilter(query, () => go({ cursor: "", from: 0 }, typingMs));
  const pages = pager((next) => {
    go(next, 0);
    main.scrollIntoView();
  });
  const count = h("output.muted");
  const choosing = choice(() => listSoon(0));
  const { element, arrange } = jobTable();
  const tools = h("div.tools", { role: "search" }, filter.elements, count, choosing.element);
  const waits = h("div");  // what keeps all jobs from going on
  const body = h("div");
  main.append(h("h1", "Jobs"), waits, tools, body, pages.element);

  function onchoose(id, on) {
    if (on) chosen.add(id);
    else chosen.delete(id);
    choosing.show();
  }

  /// The address holds what is not as at first.
  function go(next, ms) {
    place = next;
    remember(queryOf({ ...filter.values(), ...place }));
    listSoon(ms);
  }

  function draw({ jobs, total, counts, next }) {
    const all = Object.values(counts).reduce((sum, n) => sum + n, 0);
    const before = rows;
    rows = new Map(jobs.map((job) => [job.id, before.get(job.id) ?? jobRow(job.id, onchoose)]));
    for (const job of jobs) {
      known.set(job.id, standing(job));
      rows.get(job.id).set(job, chosen.has(job.id));
    }
    arrange([...rows.values()].map((row) => row.element));
    filter.count(counts);
    const none = all === 0 && !filter.active();
    tools.hidden = none;
    setText(count, filter.active() ? `${total} of ${all}` : `${all} jobs`);
    pages.show(place, jobs.length, total, next);
    const shown = none ? empty : total === 0 ? note("No job matches the filter.") : element;
    if (body.firstChild !== shown) body.replaceChildren(shown);
  }

  /// Asks for the page; an answer that a newer question has overtaken is dropped.
  async function list() {
    asked += 1;
    const mine = asked;
    const [found, health] = await Promise.all([
      getJobs({ ...filter.values(), cursor: place.cursor, limit: pageSize }, signal), getHealth(signal)]);
    if (found.total === 0) empty ??= await noJobs(signal);
    if (mine !== asked) return;
    last = found.last_event;
    replace(waits, health.obstacle && warning(`Jobs wait: ${health.obstacle}`));
    draw(found);
  }

  const listSoon = soon(list, (error) => setText(count, error.message), signal);

  await list();
  listen(() => `/api/events?after=${encodeURIComponent(last)}`, {
    job(entry, id) {
      last = id || last;
      rows.get(entry.id)?.set(entry, chosen.has(entry.id));
      // What is on the page, and the counts, change only with the jobs' states.
      if (known.get(entry.id) !== standing(entry)) listSoon(soonMs);
      known.set(entry.id, standing(entry));
    },
    removed({ id }, event) {
      last = event || last;
      known.delete(id);
      if (chosen.delete(id)) choosing.show();
      listSoon(soonMs);
    },
    reset: () => listSoon(soonMs),
  }, () => pollOn(list, pollMs, signal), signal);
}
