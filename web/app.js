// The router: one view per hash route, or only its curves (`embed`), until its AbortSignal; and the list of keys.
import { ApiError, getStates } from "./api.js";
import { ask, button, facts, h, problem, replace } from "./dom.js";
import { states } from "./format.js";

const routes = [
  { pattern: /^\/$/, view: "jobs" },
  { pattern: /^\/job\/(?<id>[^/]+)$/, view: "job", alone: true },
  { pattern: /^\/compare$/, view: "compare", alone: true },
  { pattern: /^\/new$/, view: "new" },
  { pattern: /^\/sweeps$/, view: "sweeps" },
  { pattern: /^\/sweep\/(?<id>[^/]+)$/, view: "sweeps" },
];

const keys = [
  ["?", "show this list"], ["Esc", "close a dialog"],
  ["e, E", "exposure half a stop up, down"], ["[, ]", "previous, next layer"],
  ["+, −, wheel", "zoom (wheel: once the picture has the focus)"], ["arrows, drag", "move the picture"],
  ["0 or f, o", "fit to the window; one to one"], ["1 … 9", "show the picture with this number"],
  ["p", "show the brightest paths of the pixel under the pointer"],
  [", .", "move the divider of two pictures; make the crop smaller, larger"],
  ["arrows, drag", "crops: move the crop; choose another"],
];

const main = document.getElementById("main");
let leaving = new AbortController();
let shown = false;

const explain = (error) => h("section", { role: "alert" },
  h("h1", error.title ?? "This view failed"),
  problem(error instanceof ApiError ? error.message : String(error)),
  h("p.tools", button("Try again", route), h("a", { href: "#/" }, "All jobs")));

async function route() {
  leaving.abort();
  document.querySelector("dialog")?.close();
  leaving = new AbortController();
  const { signal } = leaving;
  const [hash, search] = location.hash.slice(1).split("?", 2);  // "#/compare?jobs=a,b"
  const path = hash || "/";
  const query = new URLSearchParams(search);
  const match = routes.find(({ pattern }) => pattern.test(path));
  const alone = Boolean(query.has("embed") && match?.alone);
  document.body.classList.toggle("embed", alone);
  for (const link of document.querySelectorAll("nav a")) link.ariaCurrent = link.hash === `#${path}` ? "page" : null;
  replace(main);
  delete main.dataset.ready;
  if (shown) main.focus({ preventScroll: true });
  shown = true;
  window.scrollTo(0, 0);
  try {
    if (!match) throw new ApiError(404, { title: "No such view", detail: `There is no view #${path}.` });
    const [view, all] = await Promise.all([import(alone ? "./curve_panel.js" : `./view_${match.view}.js`),
      Object.keys(states).length > 0 ? [] : getStates()]);
    for (const { name, ...state } of all) states[name] = state;
    signal.throwIfAborted();
    await view.show(main, { params: match.pattern.exec(path).groups ?? {}, query, signal });
  } catch (error) {
    if (signal.aborted) return;
    document.title = "Lacuna";
    replace(main, explain(error));
  }
  main.dataset.ready = "";
}

// "#main" is the skip link's target, not a view.
window.addEventListener("hashchange", () => {
  if (location.hash === "#main") history.replaceState(null, "", "#/");
  else route();
});

/// Shows the keys, unless a dialog is open already.
const showKeys = () => document.querySelector("dialog")
  ?? ask("Keys", [facts(keys, "keys-help"), "The keys for pictures work while a picture has the focus."]);

document.addEventListener("keydown", (event) => {
  if (event.key === "?" && !event.target.matches("input, textarea, select")) showKeys();
});
document.getElementById("keys").onclick = showKeys;
route();
