// A sweep's answers (docs/sweeps-and-reports.md) in words, as a figure and as a table, on the page and in the report.
import { axes, errorAt } from "./curve.js";
import { choice, chooser, h, note, replace, scroll, small, update, warning } from "./dom.js";
import { colours, figureBox } from "./figure.js";
import { number, seconds, significant, thin } from "./format.js";
import { metrics } from "./job_tables.js";

/// "0.0123 (0.011–0.014)": an estimate with its interval, if it has one.
function estimateText(estimate, unit = "") {
  if (!estimate) return "—";
  const { value, low, high, at_least: least } = estimate;
  const interval = low === undefined ? "" : ` (${significant(low)}–${significant(high)})`;
  return `${least ? "> " : ""}${significant(value)}${unit}${interval}`;
}

/// Compares a gain's interval with 1 (no difference): "better", "worse", or "" if it contains 1.
const verdict = (gain) => ((gain?.at_least ? gain.value : gain?.low) > 1 ? "better"
  : !gain?.at_least && gain?.high < 1 ? "worse" : "");

/// The last part of each pointer, extended where two have the same end.
function settingNames(pointers) {
  return pointers.map((pointer) => {
    const parts = pointer.split("/").slice(1);
    const endings = parts.map((_, i) => parts.slice(-1 - i).join("/"));
    return endings.find((name) => pointers.filter((p) => p.endsWith(`/${name}`)).length === 1) ?? endings.at(-1);
  });
}

const settingText = (value) => (typeof value === "string" ? value : JSON.stringify(value));

/// The settings whose values differ among `cells`: [{pointer, name}].
function varyingSettings(pointers, cells) {
  const varying = pointers.filter((pointer) =>
    new Set(cells.map((cell) => JSON.stringify(cell.settings[pointer]))).size > 1);
  return settingNames(varying).map((name, i) => ({ name, pointer: varying[i] }));
}

/// The names of `cells`, from the settings in which they differ.
function cellNames(answers, cells) {
  const settings = varyingSettings(answers.settings, cells);
  return new Map(cells.map(({ cell, settings: values }) => [cell,
    settings.map(({ pointer, name }) => `${name} ${settingText(values[pointer])}`).join(", ") || "the job"]));
}

function timeText(to, runs) {
  if (to.time) return `${to.at_most ? "≤ " : ""}${estimateText(to.time)}${thin}s`;
  if (to.reached > 0) return `reached by ${to.reached} of ${runs} runs`;
  return to.at_least ? `not reached in ${significant(to.at_least)}${thin}s` : "not reached";
}

const errorText = (at, runs) => (at.error ? estimateText(at.error) : `measured in ${at.reached} of ${runs} runs`);

function paysText({ pays: { cold: pays }, preparation }) {
  if (preparation.cold === null) return "unknown";
  if (!pays) return "not within the measured time";
  return pays.from_the_start ? "immediately" : `after ${significant(pays.seconds)}${thin}s`;
}

/// The measured bias as text: an interval above 0 is a bias.
function biasText(cell) {
  const bias = cell.bias_between_runs ?? cell.bias_squared;
  if (!bias) return "—";
  if (bias.low === undefined) return "needs several runs";
  return bias.low > 0 ? `biased: ${estimateText(bias)}` : `none seen (below ${significant(Math.max(bias.high, 0))})`;
}

const someOf = (cells, names) => cells.slice(0, 3).map((c) => names.get(c)).join("; ")
  + (cells.length > 3 ? ` and ${cells.length - 3} more` : "");

const charges = [
  { key: "render", label: "rendering only" },
  { key: "warm", label: "with preparation, cache warm" },
  { key: "cold", label: "with preparation, cache cold" },
];

/// A cell's mean curve: {x, y, low, high, floor}, with the preparation seconds of `charge`; empty if they are unknown.
function bandPoints(cell, charge) {
  const shift = charge === "render" ? 0 : cell.preparation[charge];
  if (shift === null) return [];
  return cell.curve.map(([time, y, low, high, floor]) => ({ x: time + shift, y, low, high, floor: floor === 1 }));
}

const count = (n, one) => `${number(n)} ${n === 1 ? one : `${one}s`}`;

const tables = [
  { key: "time", label: "error at equal time" },
  { key: "error", label: "time to equal error" },
  { key: "cost", label: "efficiency, preparation, bias" },
];

/// Values at the reference's noise are in parentheses.
const told = (text, supported) => (supported ? text : h("span.muted",
  { title: "At the reference's own noise: not supported" }, `(${text})`));

const gainCell = (gain, supported = true) => h("span", { className: verdict(gain),
  title: gain && verdict(gain) === "" ? "Not significantly different from 1" : "" },
    told(estimateText(gain, "×"), supported));

/// A pair of columns for each of `values`, the last first, as the most interesting. `list` of a cell has the results,
/// under the names in `what`: {value, gain, head, show(found, runs), gainHead}.
const pairColumns = (values, list, what) => values.map((value, i) => [
  { key: list + i, head: what.head(value), value: (c) => c[list][i]?.[what.value]?.value,
    show: (c) => (c[list][i] ? told(what.show(c[list][i], c.done), c[list][i].supported) : "—") },
  { key: what.gain.split("_")[0] + i, head: what.gainHead, value: (c) => -(c[list][i]?.[what.gain]?.value ?? 0),
    show: (c) => gainCell(c[list][i]?.[what.gain], c[list][i]?.supported) },
]).reverse().flat();

const timeColumns = ({ seconds: all }) => pairColumns(all, "at", { value: "error", gain: "gain", show: errorText,
  head: (t) => `at ${significant(t)} s`, gainHead: "× the baseline" });

const errorColumns = ({ errors }) => pairColumns(errors, "to", { value: "time", gain: "speed_up", show: timeText,
  head: (e) => `to ${significant(e, 2)}`, gainHead: "speed-up" });

const costColumns = [
  { key: "efficiency", head: "efficiency 1/(MSE·s)", value: (c) => -(c.efficiency?.value ?? 0),
    show: (c) => estimateText(c.efficiency) },
  { key: "better", head: "× the baseline", value: (c) => -(c.efficiency_gain?.value ?? 0),
    show: (c) => gainCell(c.efficiency_gain) },
  { key: "cold", head: "preparation, cold", value: (c) => c.preparation.cold,
    show: (c) => seconds(c.preparation.cold) },
  { key: "warm", head: "warm", value: (c) => c.preparation.warm, show: (c) => seconds(c.preparation.warm) },
  { key: "pays", head: "pays (cold)", value: (c) => c.pays.cold?.seconds,
    show: (c) => (c.baseline === null || c.baseline === c.cell ? "—" : paysText(c)) },
  { key: "bias", head: "bias²", value: (c) => (c.bias_between_runs ?? c.bias_squared)?.value, show: biasText },
  { key: "variance", head: "variance", value: (c) => c.variance?.value, show: (c) => estimateText(c.variance) },
];

function runsCell(cell) {
  const tainted = cell.runs.filter((r) => r.tainted);
  return h("span", { title: tainted.map((r) => `${r.name}: ${r.tainted}`).join("\n") },
    `${cell.done} of ${cell.runs.length}`, tainted.length > 0 && h("span.worse", `, ${tainted.length} tainted`));
}

function columnsOf(answers, picture, cells, which) {
  const settings = varyingSettings(answers.settings, cells).map(({ pointer, name }) => ({ key: pointer, head: name,
    title: pointer, value: (c) => c.settings[pointer], show: (c) => settingText(c.settings[pointer]) }));
  const runs = { key: "runs", head: "runs", value: (c) => c.done, show: runsCell };
  return [...settings, runs, ...{ time: timeColumns, error: errorColumns, cost: () => costColumns }[which](picture)];
}

/// Sorts numbers before text, and missing values last.
function order(a, b) {
  if (a === undefined || a === null) return b === undefined || b === null ? 0 : 1;
  if (b === undefined || b === null) return -1;
  if (typeof a === "number" && typeof b === "number") return a - b;
  return settingText(a).localeCompare(settingText(b), "en", { numeric: true });
}

/// The cells of one picture as a table that can be sorted. `which`: a key of `tables`; `query` has `sort` ("KEY", or
/// "-KEY" for the reverse), the cells in `chosen` (a Set) are checked; `choose(key)(value)` changes the query.
function answersTable({ answers, picture, cells, which, query, chosen, choose }) {
  const columns = columnsOf(answers, picture, cells, which);
  const asked = query.get("sort") ?? "";
  const by = columns.find((c) => c.key === asked.replace(/^-/, ""));
  const turn = asked.startsWith("-") ? -1 : 1;
  const sorted = by ? cells.toSorted((a, b) => turn * order(by.value(a), by.value(b)) || a.cell - b.cell) : cells;
  const heads = columns.map((column) => h("th", { scope: "col", title: column.title ?? "",
    "aria-sort": column === by ? (turn > 0 ? "ascending" : "descending") : null },
  small([column.head, column === by && (turn > 0 ? " ▲" : " ▼")],
    () => choose("sort")(asked === column.key ? `-${column.key}` : column.key))));
  const tick = (cell, on) => {
    if (on) chosen.add(cell);
    else chosen.delete(cell);
    choose("cells")([...chosen].join(","));
  };
  const rows = sorted.map((cell) => h("tr", { id: `cell-${cell.cell}` },
    h("td", h("input", { type: "checkbox", checked: chosen.has(cell.cell), "aria-label": `Show cell ${cell.cell}`,
      onchange: (event) => tick(cell.cell, event.target.checked) })),
    h("th", { scope: "row" }, cell.cell, cell.baseline === cell.cell && h("span.muted", " baseline")),
    columns.map((column) => h("td.number", column.show(cell)))));
  return scroll(`Table of ${count(cells.length, "cell")}`,
    h("table.values.sortable", h("thead", h("tr", h("th", "shown"), h("th", { scope: "col" }, "cell"), heads)),
      h("tbody", rows)));
}

/// The cells shown initially: those of the front and their baselines.
function natural(picture, cells) {
  const leading = [...picture.front.render, ...picture.front.cold].map((part) => part.cell);
  const all = leading.flatMap((n) => [n, cells.find((c) => c.cell === n)?.baseline]);
  return [...new Set(all.filter(Boolean))].slice(0, colours);
}

/// The part of a curve between two times, with its ends interpolated in log-log.
function clipped(curve, from, to) {
  const at = (x) => ({ x, y: errorAt(curve, x) ?? (x < curve[0].x ? curve[0] : curve.at(-1)).y });
  return [at(from), ...curve.filter((p) => p.x > from && p.x < to), at(to)];
}

/// A figure of `cells`, on the time axis of `charge`: the chosen ones with marks and bands, and the front.
function figureOf(answers, picture, cells, names, charge, chosen) {
  const points = new Map(cells.map((c) => [c.cell, bandPoints(c, charge.key)]).filter(([, of]) => of.length > 0));
  const index = (cell) => (chosen.includes(cell) ? chosen.indexOf(cell) : undefined);
  const curves = [...points].map(([cell, of]) => ({ name: names.get(cell), points: of, index: index(cell) }));
  return {
    curves: curves.toSorted((a, b) => a.index - b.index),
    front: picture.front[charge.key].filter(({ cell }) => points.has(cell))
      .map(({ cell, from, to }) => clipped(points.get(cell), from, to)),
    axis: { label: `${axes.find((a) => a.key === answers.clock).label}, ${charge.label}`, unit: "s" },
    metric: metrics.find((m) => m.key === answers.metric),
  };
}

function frontList(front, names, charge) {
  if (front.length === 0) return note(charge === "render" ? "No run is done yet." : "No run measured its preparation.");
  return h("ol.front", front.map((part) => {
    const doubts = [
      part.tied.length > 0 && `tied with ${someOf(part.tied, names)}`,
      !part.supported && "at the reference's own noise: not supported",
    ].filter(Boolean).join("; ");
    return h("li", `${significant(part.from)} to ${significant(part.to)}${thin}s: `, h("strong", names.get(part.cell)),
      doubts && h("span.muted", ` (${doubts})`));
  }));
}

/// The answers with their controls. `query` (URLSearchParams) and the URL store every choice. `pictures(picture, cells,
/// names, all)` returns an element with the pictures of the chosen cells out of `all`, or null. `show(answers)` redraws.
export function answersView(query, pictures) {
  const [above, below, crops] = [h("div"), h("div"), h("section")];
  const figure = figureBox("No run is done yet.");
  let answers = null;

  const choose = chooser(query, draw);
  /// One of `options` by its key in the query, else the first.
  const picked = (options, key) => options.find((o) => o.key === query.get(key)) ?? options[0];

  function chosenCells(picture, cells) {
    if (!query.has("cells")) return natural(picture, cells);
    return query.get("cells").split(",").map(Number).filter((n) => picture.cells.includes(n));
  }

  function draw() {
    const options = answers.pictures.map((p, i) => ({ key: String(i + 1), label: p.text || "all cells" }));
    const several = options.length > 1;
    const number = Number(picked(options, "picture").key);
    const picture = answers.pictures[number - 1];
    const cells = picture.cells.map((n) => answers.cells[n - 1]);
    const names = cellNames(answers, cells);
    const charge = picked(charges, "charge");
    const which = picked(tables, "table");
    const chosen = chosenCells(picture, cells);
    update(above, answers.warnings.map(warning),
      h("div.switches", several && choice("Picture", options, String(number), (value) => {
        query.delete("cells");
        choose("picture")(value);
      }), choice("Time", charges, charge.key, choose("charge"))),
      several && note("Only cells that estimate the same picture are compared: of one scene, camera and resolution, "
        + "against one reference."),
      h("section", h("h2", "Lowest error"), frontList(picture.front[charge.key], names, charge.key)));
    figure.draw(figureOf(answers, picture, cells, names, charge, chosen));
    update(below, h("h2", "All cells"), h("div.switches", choice("Table", tables, which.key, choose("table"))),
      answersTable({ answers, picture, cells, which: which.key, query, chosen: new Set(chosen), choose }),
      note("Means are geometric, over the seeds; in parentheses 95 % intervals (Student's t of the logarithms, "
        + "Welch's for ratios). A ratio whose interval contains 1 is not significant."));
    replace(crops, pictures(number, chosen.map((n) => answers.cells[n - 1]), names, cells));
  }

  return {
    element: h("div.answers", above, figure.element, below, crops),
    show(next) {
      answers = next;
      draw();
    },
  };
}

/// "9 cells of integrator/guide and resolution, 3 seeds: 27 of 27 runs done".
export function summary(answers) {
  const runs = Object.values(answers.states).reduce((sum, n) => sum + n, 0);
  const names = settingNames(answers.settings).join(", ");
  return `${count(answers.cells.length, "cell")}${names && ` of ${names}`}, ${count(answers.seeds, "seed")}: `
    + `${answers.states.done ?? 0} of ${count(runs, "run")} done`;
}
