// report.json as tables, for any keys, as bars of time and rays, and the choice of a job of `auto`.
import { facts, h, note, table } from "./dom.js";
import { colours, curveColour, figureSvg, svg } from "./figure.js";
import { number, quantity, seconds, words } from "./format.js";

/// The numbers and words in a report: [{keys, value}], the innermost key first; lists of plain values
/// count as one, and the records of a list are numbered from 1.
export function leaves(value, keys = []) {
  if (value === null || typeof value !== "object") return [{ keys, value }];
  if (Array.isArray(value) && value.every((v) => v === null || typeof v !== "object")) {
    return [{ keys, value: value.join(", ") || "none" }];
  }
  const first = Array.isArray(value) ? 1 : 0;
  return Object.entries(value).flatMap(([key, v]) => leaves(v, [first ? String(Number(key) + first) : key, ...keys]));
}

/// The name of a value within its section: "build voxelise".
const leafName = (keys) => keys.toReversed().map(words).join(" ");

function section(title, value) {
  const rows = leaves(value).map(({ keys, value: v }) => [leafName(keys), quantity(v, [...keys, title])]);
  return rows.length > 0 && h("section", h("h3", words(title)), table(["", ""], rows, true));
}

/// A section for each part of a report, single values first.
function reportTables({ artefacts, choice, threads, ...report }) {
  const parts = Object.entries(report);
  const alone = parts.filter(([, v]) => v === null || typeof v !== "object");
  return h("div.report", section("job", Object.fromEntries(alone)),
    parts.filter((part) => !alone.includes(part)).map(([title, value]) => section(title, value)));
}

const block = (title, ...content) => h("section.stacked", h("h3", title), content);
const sumOf = (values) => values.reduce((sum, value) => sum + value, 0);

/// An element in the i-th curve's colour.
function painted(element, i) {
  element.style.background = curveColour(i);
  return element;
}

/// The numbers in `object` whose name `belongs`, largest first, as shares of a bar with a legend.
function stackedBar(title, object, show, belongs) {
  const parts = leaves(object ?? {}).map(({ keys, value }) => ({ name: leafName(keys), value }))
    .filter(({ name, value }) => typeof value === "number" && belongs(name)).sort((a, b) => b.value - a.value);
  if (parts.length === 0) return false;
  const total = sumOf(parts.map(({ value }) => value));
  const percent = ({ value }) => (total > 0 ? (100 * value) / total : 0);
  const pieces = parts.map((part, i) => {
    const piece = painted(h("span", { title: `${part.name}: ${show(part.value)}` }), i);
    piece.style.width = `${percent(part)}%`;
    return piece;
  });
  const entries = parts.map((part, i) => h("li", painted(h("span.swatch"), i),
    `${part.name} `, h("span.muted", `${show(part.value)}, ${percent(part).toFixed(1)} %`)));
  return block(`${title}: ${show(total)} in total`,
    h("div.stacked-bar", { "aria-hidden": "true" }, pieces), h("ul", entries));
}

/// An artefact is a name, or {name, seconds, bytes, ...}.
function artefactText(artefact) {
  if (artefact === null || typeof artefact !== "object") return String(artefact);
  const { name, ...rest } = artefact;
  const more = Object.entries(rest).map(([key, value]) =>
    quantity(value, [key]) + (key === "seconds" ? "" : ` ${key.split("_")[0]}`));
  return more.length > 0 ? `${name} (${more.join(", ")})` : String(name);
}

/// The built and loaded artefacts, and the unneeded parts of the scene.
function builtList({ artefacts, scene = {} }) {
  const rows = { built: [], loaded: [], left_out: [], ...artefacts };
  const { in_scene: there = 0, decoded = 0 } = scene.textures ?? {};
  const unneeded = Object.keys(scene).filter((key) => scene[key] === "not needed").map(words);
  rows.left_out = [...rows.left_out, ...unneeded,
    ...(there > decoded ? [`${number(there - decoded)} of ${number(there)} textures`] : [])];
  return block("Built for it", facts(Object.entries(rows).map(([key, list]) =>
    [words(key), list.map(artefactText).join(", ") || "nothing"])));
}

/// By section: the seconds of all threads in loops, those in which one thread alone worked, and those that threads
/// waited for the last one of a loop. Sections that kept threads waiting longest come first; those of less than a
/// thousandth of the whole are left out.
function threadTable({ threads, machine = {} }) {
  const count = machine.threads ?? 1;
  const rows = Object.entries(threads.sections)
    .map(([name, s]) => ({ name, ...s, idle: s.serial * (count - 1) + s.waiting }))
    .sort((a, b) => b.idle - a.idle || b.busy - a.busy);
  const least = sumOf(rows.map((s) => s.busy + s.idle)) / 1000;
  const shown = rows.filter((s) => s.busy + s.idle >= least);
  return block(`Threads: ${seconds(threads.serial_seconds)} with one thread at work, ` +
    `${seconds(threads.waiting_seconds)} of waiting for others`,
    table(["Section", "One thread", "Waiting", "All threads"],
      shown.map((s) => [s.name, seconds(s.serial), seconds(s.waiting), seconds(s.busy)]), true));
}

/// CPU seconds measure the same work by another clock, so they are not part of the total.
const effortView = (report) => h("div.effort",
  stackedBar("Time", report.seconds, seconds, (name) => !name.endsWith("cpu")),
  stackedBar("Rays", report.counts, number, (name) => ["rays", "shadow rays"].includes(name)),
  builtList(report));

/// The error of each candidate against its own time, after each of its turns.
function turnsFigure({ candidates, metric }) {
  const curves = candidates.map(({ name, turns }) => ({ name, points: turns
    .filter(({ noise, cpu_seconds: x }) => noise > 0 && x > 0)
    .map(({ noise, bias, cpu_seconds: x }) => ({ x, y: noise + bias })) }))
    .filter(({ points }) => points.length > 0).map((curve, i) => ({ ...curve, index: i < colours ? i : undefined }));
  return block("After each turn", figureSvg({ curves, axis: { label: "its own time", unit: "CPU s" },
    metric: { label: `${metric}, estimated from halves` } }, 640) ?? "");
}

function candidateTable({ candidates, chosen, metric }) {
  const orNone = (value) => (value === undefined || value === null ? "" : number(value));
  return table(["Method", "Iterations", "CPU time", `${metric} expected at the end`, ""],
    candidates.map(({ name, turns, left }, k) => {
      const last = turns.at(-1) ?? { iterations: 0, cpu_seconds: 0 };
      return [name, number(last.iterations), seconds(last.cpu_seconds), orNone(last.expected), k === chosen ? "chosen" : left];
    }), true);
}

const choiceView = (choice) => h("div.candidates", candidateTable(choice), h("div.effort", turnsFigure(choice)));

/// Everything that a job's view shows of report.json.
export const reportParts = (report) => [
  report.choice && [h("h2", "Choice of the method"), choiceView(report.choice)],
  h("h2", "Time and rays"), effortView(report), report.threads && h("div.threads", threadTable(report)),
  h("h2", "Report"), reportTables(report),
];
