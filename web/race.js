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

function fateText({ in_use, left, tail_known, unexplained }) {
  const doubts = [tail_known === false && "rare bright paths: not sure", unexplained && "differs from the others"];
  const fate = in_use ? "in use" : left ? `left in round ${left.round}: ${left.reason}` : "no part of the picture";
  return [fate, ...doubts.filter(Boolean)].join("; ");
}

function candidateTable({ clock, candidates }) {
  const cost = (c) => (clock === "rays" ? number(c.cost) : seconds(c.cost));
  return table(["Method", "MSE over the best's", "Iterations", clock === "rays" ? "Rays" : "CPU time", "Prepared in", ""],
    candidates.map((c) => [c.name, ratioText(c.over_best), number(c.iterations), cost(c), seconds(c.preparation_seconds),
      fateText(c)]), true);
}

/// Each block of pixels in the colour of the candidate with the largest weight there.
function blockMap({ blocks, candidates }) {
  if (!blocks) return false;
  const rows = Math.ceil(blocks.candidate.length / blocks.across);
  const map = svg("svg", { viewBox: `0 0 ${blocks.across} ${rows}`, width: 320, role: "img", "shape-rendering": "crispEdges",
    "aria-label": "Which candidate has the largest weight in each block of pixels" });
  blocks.candidate.forEach((k, i) => map.append(svg("rect", { x: i % blocks.across, y: Math.floor(i / blocks.across),
    width: 1, height: 1, fill: curveColour(k) })));
  const used = [...new Set(blocks.candidate)].sort((a, b) => a - b);
  const entries = used.map((k) => {
    const swatch = h("span.swatch");
    swatch.style.background = curveColour(k);
    return h("li", swatch, candidates[k].name);
  });
  return h("section.stacked", h("h3", `Largest weight in each block of ${blocks.pixels} × ${blocks.pixels} pixels`), map,
    h("ul", entries));
}

function summary({ clock, spent, plan, break_even }) {
  const cost = clock === "rays" ? `${number(spent)} rays` : seconds(spent);
  const parts = [`The race took ${cost}.`];
  if (plan.expected_rmse) parts.push(`RMSE expected at the end of the budget: ${number(plan.expected_rmse)}.`);
  if (plan.over_best_alone < 1) {
    parts.push(`Several methods share the picture: ${number(plan.over_best_alone)} of the MSE of the best alone.`);
  }
  for (const { below_seconds, better } of break_even) parts.push(`Below ${seconds(below_seconds)}, preparation included: ${better}.`);
  return h("p.note", parts.join(" "));
}

/// `race`: report.json's.
export const raceView = (race) => h("div.race", summary(race), candidateTable(race),
  h("div.effort", h("section.stacked", h("h3", "Standing after each round"), figure(race)), blockMap(race)));
