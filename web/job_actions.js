// What can be done to a job: a button each, where its state allows it.
import { change, remove, tell } from "./api.js";
import { ask } from "./dialog.js";
import { button, h, setText, sign } from "./dom.js";
import { can } from "./status.js";

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

/// `changed()` is called after the job was changed, `gone()` after it was deleted, and `failed(text)`
/// where the service refused. `show(detail)` says how the job stands (GET /api/jobs/ID).
export function jobActions(id, { changed, gone, failed }) {
  let job = null;
  const act = (call, then = changed) => async () => {
    failed("");
    try {
      if (await call() !== false) then();
    } catch (error) {
      failed(error.message);
    }
  };
  const by = (step) => act(() => change(id, { priority: job.priority + step }));
  const level = h("output.muted");
  const parts = {
    priority: h("span.tools", level, sign("−", "Lower priority", by(-1)), sign("+", "Higher priority", by(1))),
    hold: button("Hold", act(() => change(id, { held: true }))),
    release: button("Release", act(() => change(id, { held: false }))),
    retry: button("Retry", act(() => tell(id, "retry"))),
    extend: button("Extend …", act(() => askBudget(id, job.job))),
    cancel: button("Cancel job", act(() => ask("Cancel this job?", "What it has rendered so far is kept.",
      "Cancel job", () => tell(id, "cancel"))), { className: "danger" }),
    delete: button("Delete …", act(() => ask("Delete this job?", "This also deletes its pictures, curve and report.",
      "Delete for good", () => remove(id)), gone), { className: "danger" }),
  };
  return {
    element: h("div.tools.actions", { role: "group", "aria-label": "What can be done" },
      Object.values(parts)),
    show(detail) {
      job = detail;
      const { state } = detail.state;
      for (const [name, part] of Object.entries(parts)) part.hidden = !can(name, state);
      setText(level, `priority ${detail.priority}`);
    },
  };
}
