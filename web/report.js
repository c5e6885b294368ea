// report.json as tables, whatever keys it has, as bars of time and rays, and the race of a job that chose its method.
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

/// What a value is called among its section's: "build voxelise".
const leafName = (keys) => keys.toReversed().map(words).join(" ");

function section(title, value) {
  const rows = leaves(value).map(({ keys, value: v }) => [leafName(keys), quantity(v, [...keys, title])]);
  return rows.length > 0 && h("section", h("h3", words(title)), table(["", ""], rows, true));
}

/// A section for each of a report's parts, what stands alone first.
function reportTables({ artefacts, race, ...report }) {
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

/// The numbers in `object` whose name `belongs`, the largest first, as shares of a bar with a legend.
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
  return block(`${title}: ${show(total)} in all`,
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

/// What was built and loaded, and what of the scene was there and not needed.
function builtList({ artefacts, scene = {} }) {
  const rows = { built: [], loaded: [], left_out: [], ...artefacts };
  const { in_scene: there = 0, decoded = 0 } = scene.textures ?? {};
  const unneeded = Object.keys(scene).filter((key) => scene[key] === "not needed").map(words);
  rows.left_out = [...rows.left_out, ...unneeded,
    ...(there > decoded ? [`${number(there - decoded)} of ${number(there)} textures`] : [])];
  return block("Built for it", facts(Object.entries(rows).map(([key, list]) =>
    [words(key), list.map(artefactText).join(", ") || "nothing"])));
}

/// CPU seconds are the same work on another clock, so they are no part of the whole.
const effortView = (report) => h("div.effort",
  stackedBar("Time", report.seconds, seconds, (name) => !name.endsWith("cpu")),
  stackedBar("Rays", report.counts, number, (name) => ["rays", "shadow rays"].includes(name)),
  builtList(report));

function raceFigure({ candidates, rounds, clock }) {
  const curves = candidates.map(({ name }) => ({ name, points: rounds
    .filter((row) => row.candidate === name && row.low > 0 && row.high > 0 && row.cost > 0)
    .map((row) => ({ x: row.cost, y: row.ratio, low: row.low, high: row.high })) }))
    .filter(({ points }) => points.length > 0).map((curve, i) => ({ ...curve, index: i < colours ? i : undefined }));
  const axis = { label: "its own time", unit: clock === "rays" ? "rays" : "CPU s" };
  return block("Standing after each round",
    figureSvg({ curves, axis, metric: { label: "MSE over the best's at equal time" } }, 640) ?? "");
}

const ratioText = (ratio) => (!ratio || ratio.ratio === null ? "unknown"
  : `${number(ratio.ratio)} (${number(ratio.low)} to ${number(ratio.high)})`);

function fateText({ in_use, left, tail_known, unexplained, bias_rmse, bias_known }) {
  return [
    in_use ? "in use" : left ? `left in round ${left.round}: ${left.reason}` : "no part of the picture",
    tail_known === false && "rare bright paths: not sure",
    unexplained && "differs from the others",
    bias_rmse !== undefined && (bias_known ? `bias: RMSE ${number(bias_rmse)} stays` : "its bias is not seen"),
  ].filter(Boolean).join("; ");
}

function candidateTable({ clock, candidates }) {
  const [costHead, cost] = clock === "rays" ? ["Rays", number] : ["CPU time", seconds];
  return table(["Method", "MSE over the best's", "Iterations", costHead, "Prepared in", ""],
    candidates.map((c) => [c.name, ratioText(c.over_best), number(c.iterations), cost(c.cost),
      seconds(c.preparation_seconds), fateText(c)]), true);
}

/// One square for each block of pixels, filled by `fill(value)`.
function mapOfBlocks(values, across, label, fill) {
  const squares = values.map((value, i) => svg("rect", {
    x: i % across, y: Math.floor(i / across), width: 1, height: 1, fill: fill(value) }));
  return svg("svg", { viewBox: `0 0 ${across} ${Math.ceil(values.length / across)}`, width: 320, role: "img",
    "shape-rendering": "crispEdges", "aria-label": label }, ...squares);
}

/// Each block of pixels in the colour of the candidate with the largest weight there.
function blockMap({ pixels, across, candidate }, candidates) {
  const used = [...new Set(candidate)].sort((a, b) => a - b);
  return block(`Largest weight in each block of ${pixels} × ${pixels} pixels`,
    mapOfBlocks(candidate, across, "Which candidate has the largest weight in each block of pixels", curveColour),
    h("ul", used.map((k) => h("li", painted(h("span.swatch"), k), candidates[k].name))));
}

/// The more samples a block gets, the lighter it is.
function sampleMap({ pixels, across, iterations }) {
  const [least, most] = [Math.min(...iterations), Math.max(...iterations)];
  const mean = sumOf(iterations) / iterations.length;
  return block(`Samples in each block of ${pixels} × ${pixels} pixels`,
    mapOfBlocks(iterations, across, "How many samples each block of pixels gets",
      (n) => `hsl(0 0% ${Math.round(8 + 87 * n / most)}%)`),
    note(`Over the mean: ${number(least / mean)} (dark) to ${number(most / mean)} (light).`));
}

function raceSummary({ clock, spent, reduction, plan, break_even }) {
  const cost = clock === "rays" ? `${number(spent)} rays` : seconds(spent);
  return [
    `The race took ${cost}${reduction > 1 ? `, of pixels ${reduction} times as wide` : ""}.`,
    plan.expected_rmse && `RMSE expected at the end of the budget: ${number(plan.expected_rmse)}.`,
    plan.over_best_alone < 1
      && `Several methods share the picture: ${number(plan.over_best_alone)} of the MSE of the best alone.`,
    ...break_even.map((of) => `Below ${seconds(of.below_seconds)}, preparation included: ${of.better}.`),
  ].filter(Boolean).join(" ");
}

const raceView = (race) => h("div.race", note(raceSummary(race)), candidateTable(race),
  h("div.effort", raceFigure(race), race.blocks && blockMap(race.blocks, race.candidates),
    race.samples && sampleMap(race.samples)));

/// All that a job's view shows of report.json.
export const reportParts = (report) => [
  report.race && [h("h2", "The race"), raceView(report.race)],
  h("h2", "Time and rays"), effortView(report),
  h("h2", "Report"), reportTables(report),
];
