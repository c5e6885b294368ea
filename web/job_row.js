// A job as a row of the list.
import { h, setText } from "./dom.js";
import { integratorName, jobTitle, when } from "./format.js";
import { badge, currentError, progressBar } from "./status.js";
import { thumbnail } from "./thumbnail.js";

// The narrow layout shows rows as grids, and browsers then forget that they are a table's.
const cell = (className, ...children) => h("td", { role: "cell", className }, children);

/// A row that follows its job by `set(entry, chosen)`; cells that did not change are left alone.
export function jobRow(id, onchoose) {
  const choose = h("input", { type: "checkbox", onchange: () => onchoose(id, choose.checked) });
  const thumb = thumbnail();
  const title = h("a", { href: `#/job/${id}` });
  const detail = h("span.detail");
  const reason = h("span.reason");
  const integrator = cell("integrator");
  const state = badge();
  const progress = progressBar("Share of the budget");
  const error = cell("error");
  const created = h("time");
  const element = h("tr", { role: "row", "data-job": id },
    cell("choose", h("label", choose)),
    cell("picture-cell", h("a", { href: title.href, tabIndex: -1, "aria-hidden": "true" }, thumb.element)),
    h("th.name", { role: "rowheader", scope: "row" }, title, detail, reason),
    integrator,
    cell("state", state.element),
    cell("progress-cell", progress.element),
    error,
    cell("created", created));
  return {
    element,
    set(job, chosen) {
      const name = jobTitle(job);
      choose.ariaLabel = `Compare ${name}, ${id}`;
      choose.checked = chosen;
      setText(title, name);
      setText(detail, job.label ? `${job.scene} · ${id}` : id);
      setText(reason, job.error || job.obstacle || "");
      setText(integrator, integratorName(job.integrator));
      state.set(job.state, job.phase);
      progress.set(job.state, job.progress);
      setText(error, currentError(job.progress));
      setText(created, when(job.created));
      created.dateTime = job.created;
      thumb.update(job);
    },
  };
}

const heads = ["Job", "Integrator", "State", "Progress", "Error", "Created"];

/// A table for rows: `arrange(elements)` puts them into it in their order, moving only what is out of
/// place.
export function jobTable() {
  const body = h("tbody", { role: "rowgroup" });
  const element = h("table.jobs", { role: "table" },
    h("thead", h("tr",
      h("td.choose"), h("td.picture-cell"),
      heads.map((text) => h("th", { scope: "col" }, text)))),
    body);
  function arrange(elements) {
    elements.forEach((row, i) => {
      if (body.children[i] !== row) body.insertBefore(row, body.children[i] ?? null);
    });
    while (body.children.length > elements.length) body.lastElementChild.remove();
  }
  return { element, arrange };
}
