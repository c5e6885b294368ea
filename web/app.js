// The router: one view per hash route, and with `embed` in the query its curves alone; each is given
// an AbortSignal that ends everything it started.
import { ApiError } from "./api.js";
import { button, h, problem } from "./dom.js";
import "./keys.js";
import * as figure from "./view_figure.js";
import * as job from "./view_job.js";
import * as jobs from "./view_jobs.js";

/// A view that many never open is read when somebody does.
const later = (file) => async (...given) => (await import(file)).show(...given);

const routes = [
  { pattern: /^\/$/, show: jobs.show },
  { pattern: /^\/job\/(?<id>[^/]+)$/, show: job.show, alone: figure.show },
  { pattern: /^\/compare$/, show: later("./view_compare.js"), alone: figure.show },
  { pattern: /^\/new$/, show: later("./view_new.js") },
  { pattern: /^\/sweeps$/, show: later("./view_sweeps.js") },
  { pattern: /^\/sweep\/(?<id>[^/]+)$/, show: later("./view_sweep.js") },
];

const main = document.getElementById("main");
let leaving = new AbortController();
let shown = false;

/// "#/compare?jobs=a,b" -> the path and its query.
function address() {
  const [path, query = ""] = location.hash.replace(/^#/, "").split("?", 2);
  return { path: path || "/", query: new URLSearchParams(query) };
}

function explain(error) {
  const known = error instanceof ApiError;
  return h("section", { role: "alert" },
    h("h1", known ? error.title : "This view failed"),
    problem(known ? error.message : String(error)),
    h("p.tools", button("Try again", route), h("a", { href: "#/" }, "All jobs")));
}

async function route() {
  leaving.abort();
  document.querySelector("dialog")?.close();
  leaving = new AbortController();
  const { signal } = leaving;
  const { path, query } = address();
  const match = routes.find(({ pattern }) => pattern.test(path));
  const alone = query.has("embed") && match?.alone;
  document.body.classList.toggle("embed", Boolean(alone));
  for (const link of document.querySelectorAll("nav a")) link.ariaCurrent = link.hash === `#${path}` ? "page" : null;
  main.replaceChildren();
  delete main.dataset.ready;
  if (shown) main.focus({ preventScroll: true });
  shown = true;
  window.scrollTo(0, 0);
  try {
    if (!match) throw new ApiError(404, { title: "No such view", detail: `There is no view #${path}.` });
    await (alone || match.show)(main, { params: match.pattern.exec(path).groups ?? {}, query, signal });
  } catch (error) {
    if (signal.aborted) return;
    document.title = "Lacuna";
    main.replaceChildren(explain(error));
  }
  main.dataset.ready = "";
}

// "#main" is the skip link's target, not a view.
window.addEventListener("hashchange", () => {
  if (location.hash === "#main") history.replaceState(null, "", "#/");
  else route();
});
route();
