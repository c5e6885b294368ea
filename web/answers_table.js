// The cells of one picture as a table that can be sorted; its order and choice are part of the address.
import { biasText, count, errorText, estimateText, gainText, paysText, settingNames, settingText, timeText,
  varyingSettings, verdict } from "./answers.js";
import { h } from "./dom.js";
import { seconds, significant } from "./format.js";

export const tables = [
  { key: "time", label: "error at equal time" },
  { key: "error", label: "time to equal error" },
  { key: "cost", label: "efficiency, preparation, bias" },
];

/// What the reference is too noisy to tell stands in parentheses.
const told = (text, supported) => (supported ? text : h("span.muted",
  { title: "At the reference's own noise: not supported" }, `(${text})`));

const gainCell = (gain, supported = true) =>
  h("span", { className: verdict(gain), title: verdict(gain) === "" && gain ? "Not significantly different from 1" : "" },
    told(gainText(gain), supported));

function timeColumns(picture) {
  // The last first: that is where a reader looks.
  return picture.seconds.map((t, i) => [t, i]).reverse().flatMap(([t, i]) => [
    { key: `at${i}`, head: `at ${significant(t)} s`, value: (c) => c.at[i]?.error?.value,
      show: (c) => (c.at[i] ? told(errorText(c.at[i], c.done), c.at[i].supported) : "—") },
    { key: `gain${i}`, head: "× the baseline", value: (c) => -(c.at[i]?.gain?.value ?? 0),
      show: (c) => gainCell(c.at[i]?.gain, c.at[i]?.supported) },
  ]);
}

function errorColumns(picture) {
  return picture.errors.map((e, i) => [e, i]).reverse().flatMap(([e, i]) => [
    { key: `to${i}`, head: `to ${significant(e, 2)}`, value: (c) => c.to[i]?.time?.value,
      show: (c) => (c.to[i] ? told(timeText(c.to[i], c.done), c.to[i].supported) : "—") },
    { key: `speed${i}`, head: "speed-up", value: (c) => -(c.to[i]?.speed_up?.value ?? 0),
      show: (c) => gainCell(c.to[i]?.speed_up, c.to[i]?.supported) },
  ]);
}

const costColumns = [
  { key: "efficiency", head: "efficiency 1/(MSE·s)", value: (c) => -(c.efficiency?.value ?? 0),
    show: (c) => estimateText(c.efficiency) },
  { key: "better", head: "× the baseline", value: (c) => -(c.efficiency_gain?.value ?? 0),
    show: (c) => gainCell(c.efficiency_gain) },
  { key: "cold", head: "preparation, cold", value: (c) => c.preparation.cold, show: (c) => seconds(c.preparation.cold) },
  { key: "warm", head: "warm", value: (c) => c.preparation.warm, show: (c) => seconds(c.preparation.warm) },
  { key: "pays", head: "pays (cold)", value: (c) => c.pays.cold?.seconds,
    show: (c) => (c.baseline === null || c.baseline === c.cell ? "—" : paysText(c.pays.cold, c.preparation.cold !== null)) },
  { key: "bias", head: "bias²", value: (c) => (c.bias_between_runs ?? c.bias_squared)?.value, show: biasText },
  { key: "variance", head: "variance", value: (c) => c.variance?.value, show: (c) => estimateText(c.variance) },
];

function runsCell(cell) {
  const tainted = cell.runs.filter((r) => r.tainted);
  return h("span", { title: tainted.map((r) => `${r.name}: ${r.tainted}`).join("\n") },
    `${cell.done} of ${cell.runs.length}`, tainted.length > 0 && h("span.worse", `, ${tainted.length} tainted`));
}

function columnsOf(answers, picture, cells, which) {
  const pointers = varyingSettings(answers.settings, cells);
  const names = settingNames(pointers);
  const settings = pointers.map((p, i) => ({ key: p, head: names[i], title: p,
    value: (c) => c.settings[p], show: (c) => settingText(c.settings[p]) }));
  const runs = { key: "runs", head: "runs", value: (c) => c.done, show: runsCell };
  const rest = { time: timeColumns(picture), error: errorColumns(picture), cost: costColumns }[which];
  return [...settings, runs, ...rest];
}

/// Numbers before words, what is not there last.
function order(a, b) {
  if (a === undefined || a === null) return b === undefined || b === null ? 0 : 1;
  if (b === undefined || b === null) return -1;
  if (typeof a === "number" && typeof b === "number") return a - b;
  return settingText(a).localeCompare(settingText(b), "en", { numeric: true });
}

/// `which`: a key of `tables`; `query` has `sort` ("KEY", or "-KEY" for the other way round), the cells
/// in `chosen` (a Set) are ticked; `onsort(key)`, `onchoose(cell, on)`.
export function answersTable({ answers, picture, cells, which, query, chosen, onsort, onchoose }) {
  const columns = columnsOf(answers, picture, cells, which);
  const asked = query.get("sort") ?? "";
  const by = columns.find((c) => c.key === asked.replace(/^-/, ""));
  const turn = asked.startsWith("-") ? -1 : 1;
  const sorted = by ? cells.toSorted((a, b) => turn * order(by.value(a), by.value(b)) || a.cell - b.cell) : cells;
  const heads = columns.map((column) => h("th", { scope: "col", title: column.title ?? "",
    "aria-sort": column === by ? (turn > 0 ? "ascending" : "descending") : null },
  h("button.small", { type: "button", onclick: () => onsort(asked === column.key ? `-${column.key}` : column.key) },
    column.head, column === by && (turn > 0 ? " ▲" : " ▼"))));
  const rows = sorted.map((cell) => h("tr", { id: `cell-${cell.cell}` },
    h("td", h("input", { type: "checkbox", checked: chosen.has(cell.cell), "aria-label": `Show cell ${cell.cell}`,
      onchange: (event) => onchoose(cell.cell, event.target.checked) })),
    h("th", { scope: "row" }, cell.cell, cell.baseline === cell.cell && h("span.muted", " baseline")),
    columns.map((column) => h("td.number", column.show(cell)))));
  return h("div.scroll", { tabIndex: 0, role: "group", "aria-label": `Table of ${count(cells.length, "cell")}` },
    h("table.values.sortable", h("thead", h("tr", h("th", "shown"), h("th", { scope: "col" }, "cell"), heads)),
      h("tbody", rows)));
}
