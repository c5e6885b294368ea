// The race of a job that chose its method: who ran, how it stood, and which parts of the picture each won.
import { bandFigure } from "./band_figure.js";
import { h, table } from "./dom.js";
import { number, seconds } from "./format.js";
import { curveColour } from "./palette.js";
import { svg } from "./svg_parts.js";

const metric = { label: "MSE over the best's at equal time" };

/// Cells of a band figure: the standing of each candidate after each round.
function curves({ candidates, rounds }) {
  return candidates.map(({ name }, cell) => ({ cell, name, curve: rounds
    .filter((row) => row.candidate === name && row.low > 0 && row.high > 0 && row.cost > 0)
    .map((row) => ({ x: row.cost, y: row.ratio, low: row.low, high: row.high })) }));
}

function figure(race) {
  const cells = curves(race);
  const chosen = cells.filter((c) => c.curve.length > 0).map((c) => c.cell).slice(0, 8);
  const axis = { label: "its own time", unit: race.clock === "rays" ? "rays" : "CPU s" };
  return bandFigure(cells, chosen, [], axis, metric, 640);
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
  const entries = used.map((k) => {
    const swatch = h("span.swatch");
    swatch.style.background = curveColour(k);
    return h("li", swatch, candidates[k].name);
  });
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
    h("p.note", `Over the mean: ${number(least / mean)} (dark) to ${number(most / mean)} (light).`));
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
  return h("p.note", parts.join(" "));
}

/// `race`: report.json's.
export const raceView = (race) => h("div.race", summary(race), candidateTable(race),
  h("div.effort", h("section.stacked", h("h3", "Standing after each round"), figure(race)), blockMap(race), sampleMap(race)));
