// Which jobs of the list are asked for: those in one state, those whose texts hold a word, a sweep's.
import { h, small } from "./dom.js";
import { states } from "./status.js";

/// The controls, beginning with what `query` says. `values()` is what the address, and the request,
/// should hold; `count(counts)` says how many jobs of each state there are.
export function jobFilter(query, changed) {
  const text = h("input", {
    type: "search", value: query.get("label") ?? "", placeholder: "Filter: label, scene, integrator or id",
    "aria-label": "Filter the jobs", oninput: changed,
  });
  const options = ["", ...states].map((name) => h("option", { value: name }, name || "all states"));
  const state = h("select", { "aria-label": "State", onchange: changed }, options);
  state.value = states.includes(query.get("state")) ? query.get("state") : "";
  let sweep = query.get("sweep") ?? "";
  const runs = small("of one sweep ×", () => {
    sweep = "";
    runs.hidden = true;
    changed();
  });
  runs.hidden = sweep === "";
  return {
    elements: [text, state, runs],
    values: () => ({ label: text.value.trim(), state: state.value, sweep }),
    active: () => text.value.trim() !== "" || state.value !== "" || sweep !== "",
    count(counts) {
      for (const option of options.slice(1)) option.textContent = `${option.value} (${counts[option.value] ?? 0})`;
    },
  };
}
