// report.json as readable tables, whatever keys it has (units come from the keys), as bars of time and rays, and the race
// of a job that chose its method: who ran, how it stood, and which parts of the picture each won.
import { facts, h, note, table } from "./dom.js";
import { curveColour, figureSvg, svg } from "./figure.js";
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

/// An element in the i-th curve's colour.
function painted(element, i) {
  element.style.background = curveColour(i);
  return element;
}

/// Shares of a whole as one bar, with a legend that says the same in words; `parts` are [{name, value, text}].
function stackedBar(title, parts) {
  const total = parts.reduce((sum, p) => sum + p.value, 0);
  const percent = ({ value }) => (total > 0 ? (100 * value) / total : 0);
  const pieces = parts.map((part, i) => {
    const piece = painted(h("span", { title: `${part.name}: ${part.text}` }), i);
    piece.style.width = `${percent(part)}%`;
    return piece;
  });
  const entries = parts.map((part, i) => h("li", painted(h("span.swatch"), i),
    `${part.name} `, h("span.muted", `${part.text}, ${percent(part).toFixed(1)} %`)));
  return h("section.stacked", h("h3", title),
    h("div.stacked-bar", { "aria-hidden": "true" }, pieces), h("ul", entries));
}

/// A bar of the numbers in `object` whose name `belongs`, the largest first.
function bar(title, object, show, belongs) {
  const parts = leaves(object ?? {})
    .map(({ keys, value }) => ({ name: leafName(keys), value, text: show(value) }))
    .filter(({ name, value }) => typeof value === "number" && belongs(name)).sort((a, b) => b.value - a.value);
  const total = parts.reduce((sum, p) => sum + p.value, 0);
  return parts.length > 0 && stackedBar(`${title}: ${show(total)} in all`, parts);
}

/// An artefact is a name, or {name, seconds, bytes, ...}.
function artefactText(artefact) {
  if (artefact === null || typeof artefact !== "object") return String(artefact);
  const { name, ...rest } = artefact;
  const more = Object.entries(rest).map(([key, value]) => quantity(value, [key]) + (key === "seconds" ? "" : ` ${key.split("_")[0]}`));
  return more.length > 0 ? `${name} (${more.join(", ")})` : String(name);
}

/// What of the scene was there and not needed.
function leftOut({ scene = {} }) {
  const { textures } = scene;
  const unread = (textures?.in_scene ?? 0) - (textures?.decoded ?? 0);
  return [
    ...Object.keys(scene).filter((key) => scene[key] === "not needed").map(words),
    ...(unread > 0 ? [`${number(unread)} of ${number(textures.in_scene)} textures`] : []),
  ];
}

function builtList(report) {
  const rows = { built: [], loaded: [], left_out: [], ...report.artefacts };
  rows.left_out = [...rows.left_out, ...leftOut(report)];
  return h("section.stacked", h("h3", "Built for it"),
    facts(Object.entries(rows).map(([key, list]) => [words(key), list.map(artefactText).join(", ") || "nothing"])));
}

/// Where time and rays went, and what was built. CPU seconds are the same work on another clock, so they are no part of the whole.
const effortView = (report) => h("div.effort",
  bar("Time", report.seconds, seconds, (name) => !name.endsWith("cpu")),
  bar("Rays", report.counts, number, (name) => ["rays", "shadow rays"].includes(name)),
  builtList(report));

const standing = { label: "MSE over the best's at equal time" };

/// The standing of each candidate after each round.
function raceFigure({ candidates, rounds, clock }) {
  const curves = candidates.map(({ name }) => ({ name, points: rounds
    .filter((row) => row.candidate === name && row.low > 0 && row.high > 0 && row.cost > 0)
    .map((row) => ({ x: row.cost, y: row.ratio, low: row.low, high: row.high })) }))
    .filter(({ points }) => points.length > 0).map((curve, i) => ({ ...curve, index: i < 8 ? i : undefined }));
  const axis = { label: "its own time", unit: clock === "rays" ? "rays" : "CPU s" };
  return figureSvg({ curves, axis, metric: standing }, 640) ?? "";
}

/// "1.4 (1.2 to 1.7)".
function ratioText(ratio) {
  if (!ratio || ratio.ratio === null) return "unknown";
  return `${number(ratio.ratio)} (${number(ratio.low)} to ${number(ratio.high)})`;
}

function fateText(candidate) {
  const { in_use, left, tail_known, unexplained } = candidate;
  const doubts = [tail_known === false && "rare bright paths: not sure", unexplained && "differs from the others",
    fateOfBias(candidate)];
  const fate = in_use ? "in use" : left ? `left in round ${left.round}: ${left.reason}` : "no part of the picture";
  return [fate, ...doubts.filter(Boolean)].join("; ");
}

function candidateTable({ clock, candidates }) {
  const cost = (c) => (clock === "rays" ? number(c.cost) : seconds(c.cost));
  return table(["Method", "MSE over the best's", "Iterations", clock === "rays" ? "Rays" : "CPU time", "Prepared in", ""],
    candidates.map((c) => [c.name, ratioText(c.over_best), number(c.iterations), cost(c), seconds(c.preparation_seconds),
      fateText(c)]), true);
}

/// One square for each block of pixels, filled by `fill(value)`.
function mapOfBlocks(values, across, label, fill) {
  const map = svg("svg", { viewBox: `0 0 ${across} ${Math.ceil(values.length / across)}`, width: 320, role: "img",
    "shape-rendering": "crispEdges", "aria-label": label });
  values.forEach((value, i) => map.append(svg("rect", { x: i % across, y: Math.floor(i / across), width: 1, height: 1,
    fill: fill(value) })));
  return map;
}

/// Each block of pixels in the colour of the candidate with the largest weight there.
function blockMap({ blocks, candidates }) {
  if (!blocks) return false;
  const map = mapOfBlocks(blocks.candidate, blocks.across, "Which candidate has the largest weight in each block of pixels",
    curveColour);
  const used = [...new Set(blocks.candidate)].sort((a, b) => a - b);
  const entries = used.map((k) => h("li", painted(h("span.swatch"), k), candidates[k].name));
  return h("section.stacked", h("h3", `Largest weight in each block of ${blocks.pixels} × ${blocks.pixels} pixels`), map,
    h("ul", entries));
}

/// The more samples a block gets, the lighter it is.
function sampleMap({ samples }) {
  if (!samples) return false;
  const most = Math.max(...samples.iterations), least = Math.min(...samples.iterations);
  const mean = samples.iterations.reduce((sum, n) => sum + n, 0) / samples.iterations.length;
  const map = mapOfBlocks(samples.iterations, samples.across, "How many samples each block of pixels gets",
    (n) => `hsl(0 0% ${Math.round(8 + 87 * n / most)}%)`);
  return h("section.stacked", h("h3", `Samples in each block of ${samples.pixels} × ${samples.pixels} pixels`), map,
    note(`Over the mean: ${number(least / mean)} (dark) to ${number(most / mean)} (light).`));
}

function fateOfBias({ bias_rmse, bias_known }) {
  if (bias_rmse === undefined) return false;
  return bias_known ? `bias: RMSE ${number(bias_rmse)} stays` : "its bias is not seen";
}

function summary({ clock, spent, reduction, plan, break_even }) {
  const cost = clock === "rays" ? `${number(spent)} rays` : seconds(spent);
  const parts = [`The race took ${cost}${reduction > 1 ? `, of pixels ${reduction} times as wide` : ""}.`];
  if (plan.expected_rmse) parts.push(`RMSE expected at the end of the budget: ${number(plan.expected_rmse)}.`);
  if (plan.over_best_alone < 1) {
    parts.push(`Several methods share the picture: ${number(plan.over_best_alone)} of the MSE of the best alone.`);
  }
  for (const { below_seconds, better } of break_even) parts.push(`Below ${seconds(below_seconds)}, preparation included: ${better}.`);
  return note(parts.join(" "));
}

/// `race`: report.json's.
const raceView = (race) => h("div.race", summary(race), candidateTable(race),
  h("div.effort", h("section.stacked", h("h3", "Standing after each round"), raceFigure(race)), blockMap(race), sampleMap(race)));

/// All that a job's view shows of report.json.
export const reportParts = (report) => [
  report.race && [h("h2", "The race"), raceView(report.race)],
  h("h2", "Time and rays"), effortView(report),
  h("h2", "Report"), reportTables(report),
];
