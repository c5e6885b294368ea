// The cells of a sweep as error against time: all thin, the chosen ones with marks and bands, the front thick.
import { errorAt, slopeLine, slopeName } from "./curve.js";
import { number } from "./format.js";
import { logAxis } from "./log_axis.js";
import { curveColour } from "./palette.js";
import { axisTitle, frame, legend, line, mark, muted, size, svg } from "./svg_parts.js";

/// The part of a curve between two times, its ends interpolated in log-log.
function clipped(curve, from, to) {
  const at = (x) => ({ x, y: errorAt(curve, x) ?? (x < curve[0].x ? curve[0] : curve.at(-1)).y });
  return [at(from), ...curve.filter((p) => p.x > from && p.x < to), at(to)];
}

function band(curve, place, colour) {
  const points = [...curve.map((p) => place({ x: p.x, y: p.high })),
    ...curve.toReversed().map((p) => place({ x: p.x, y: p.low }))];
  return svg("polygon", { points: points.map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join(" "),
    fill: colour, "fill-opacity": 0.15, stroke: "none" });
}

function chosenGroup({ name, curve, index }, place, metric) {
  const marks = curve.map((p) => {
    const shape = mark(index, ...place(p), p.floor);
    const interval = p.low < p.high ? ` (${number(p.low)} to ${number(p.high)})` : "";
    shape.append(svg("title", {}, `${name}: ${metric.label} ${number(p.y)}${interval} at ${number(p.x)} s`
      + `${p.floor ? ", at the reference's noise" : ""}`));
    return shape;
  });
  const colour = curveColour(index);
  return svg("g", { class: "curve" }, band(curve, place, colour), line(curve.map(place), colour), ...marks);
}

/// `cells`: [{cell, name, curve}]; `chosen`: the numbers of those with bands, in their order; `front`:
/// [{from, to, cell}]. null if there is nothing to show.
export function bandFigure(cells, chosen, front, axis, metric, width = 720) {
  const shown = cells.filter((c) => c.curve.length > 0);
  const all = shown.flatMap((c) => c.curve);
  if (all.length === 0) return null;
  const bottom = size.top + size.plot;
  const x = logAxis(all.map((p) => p.x).concat(front.map((f) => f.to)), size.left, width - size.right, 48);
  const y = logAxis(all.map((p) => p.y), bottom, size.top, 20);
  const place = (p) => [x.at(p.x), y.at(p.y)];
  const picked = chosen.map((number_, index) => ({ ...shown.find((c) => c.cell === number_), index }))
    .filter((c) => c.curve);
  const leading = front.map((part) => [part, shown.find((c) => c.cell === part.cell)]).filter(([, c]) => c);
  const thick = { "stroke-width": 9, "stroke-opacity": 0.3, "stroke-linecap": "round" };
  const slope = metric.slope ? slopeLine(shown.map((c) => c.curve), metric.slope) : [];
  const dashed = { "stroke-dasharray": "6 4", "stroke-width": 1 };
  const entries = picked.map((c) => ({ label: c.name, symbol: (u, v) => mark(c.index, u, v, false) }));
  if (front.length > 0) {
    entries.push({ label: "lowest mean error (the front)", symbol: (u, v) => line([[u - 8, v], [u + 8, v]], muted, thick) });
  }
  if (shown.length > picked.length) {
    entries.push({ label: `${shown.length - picked.length} more`, symbol: (u, v) => line([[u - 10, v], [u + 10, v]], muted, { "stroke-width": 0.7 }) });
  }
  if (slope.length > 0) {
    entries.push({ label: `slope ${slopeName(metric.slope)} (Monte Carlo)`, symbol: (u, v) => line([[u - 10, v], [u + 10, v]], muted, dashed) });
  }
  const top = bottom + size.below + size.line / 2;
  const names = legend(width, entries, top);
  const height = top + names.height;
  return svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img",
    "aria-label": `${axisTitle(metric)} against ${axisTitle(axis)}`,
    "font-family": "DejaVu Sans, Helvetica, Arial, sans-serif" },
  svg("clipPath", { id: "plot" }, svg("rect", {
    x: size.left, y: size.top, width: width - size.left - size.right, height: size.plot })),
  svg("rect", { width, height, fill: "var(--surface)" }), ...frame(width, x, y, axis, metric),
  svg("g", { "clip-path": "url(#plot)" },
    line(slope.map(place), muted, dashed),
    ...leading.map(([part, c]) => line(clipped(c.curve, part.from, part.to).map(place), muted, { ...thick, class: "front" })),
    ...shown.filter((c) => !chosen.includes(c.cell)).map((c) => line(c.curve.map(place), muted, { "stroke-width": 0.7 })),
    ...picked.map((c) => chosenGroup(c, place, metric))),
  ...names.parts);
}
