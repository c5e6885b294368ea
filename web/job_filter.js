// Which jobs of the list are shown: those in one state whose texts hold all words.
import { h } from "./dom.js";
import { integratorName } from "./format.js";

const states = ["running", "queued", "done", "failed", "cancelled", "interrupted"];

const textOf = (job) => [job.id, job.label, job.scene, integratorName(job.integrator), job.state]
  .join(" ").toLowerCase();

/// The controls, beginning with what `query` says. `values()` is what the address should hold;
/// `pick(jobs)` gives the jobs to show, and counts those of each state.
export function jobFilter(query, changed) {
  const text = h("input", {
    type: "search", value: query.get("filter") ?? "", placeholder: "Filter: label, scene, integrator …",
    "aria-label": "Filter the jobs", oninput: changed,
  });
  const options = ["", ...states].map((name) => h("option", { value: name }, name || "all states"));
  const state = h("select", { "aria-label": "State", onchange: changed }, options);
  state.value = states.includes(query.get("state")) ? query.get("state") : "";
  return {
    elements: [text, state],
    values: () => ({ filter: text.value, state: state.value }),
    active: () => text.value.trim() !== "" || state.value !== "",
    pick(jobs) {
      const words = text.value.toLowerCase().split(/\s+/).filter(Boolean);
      const found = words.length === 0 ? jobs
        : jobs.filter((job) => words.every((word) => textOf(job).includes(word)));
      for (const option of options.slice(1)) {
        option.textContent = `${option.value} (${found.filter((job) => job.state === option.value).length})`;
      }
      return state.value === "" ? found : found.filter((job) => job.state === state.value);
    },
  };
}
