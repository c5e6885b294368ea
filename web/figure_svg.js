// Error curves as an SVG that needs nothing else: for papers, slides and pages.
import { axes, metrics, points, slopeLine, slopeName } from "./curve.js";
import { axisTitle, colours, css, ends, logTicks, tickLabel } from "./plot.js";

const size = { width: 720, left: 74, right: 18, top: 14, plot: 360, below: 52, line: 18 };

/// An SVG element with attributes; never with `style`, which the page's policy forbids.
function svg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

const text = (content, attributes) =>
  svg("text", { fill: css("--text"), "font-size": 12, ...attributes }, content);

/// Marks that are told apart without their colours.
const marks = [
  (x, y, r) => svg("circle", { cx: x, cy: y, r }),
  (x, y, r) => svg("rect", { x: x - r, y: y - r, width: 2 * r, height: 2 * r }),
  (x, y, r) => svg("path", { d: `M${x} ${y - 1.2 * r}l${1.2 * r} ${2.2 * r}h${-2.4 * r}z` }),
  (x, y, r) => svg("path", { d: `M${x} ${y - 1.4 * r}l${1.4 * r} ${1.4 * r}l${-1.4 * r} ${1.4 * r}`
    + `l${-1.4 * r} ${-1.4 * r}z` }),
];

function mark(i, x, y, hollow) {
  const colour = css(`--curve-${i % colours}`);
  const shape = marks[i % marks.length](Number(x.toFixed(2)), Number(y.toFixed(2)), 3.2);
  shape.setAttribute("stroke", colour);
  shape.setAttribute("fill", hollow ? css("--surface") : colour);
  return shape;
}

function line(places, stroke, more = {}) {
  const path = places.map(([x, y]) => `${x.toFixed(2)},${y.toFixed(2)}`).join(" ");
  return svg("polyline", { points: path, fill: "none", stroke, "stroke-width": 1.5, ...more });
}

/// A log axis: values to places, from `from` to `to`.
function logAxis(values, from, to) {
  const [min, max] = ends(values);
  const at = (v) => from + ((to - from) * Math.log(v / min)) / Math.log(max / min);
  return { at, ticks: logTicks(min, max) };
}

function frame(x, y, axis, metric) {
  const [right, bottom] = [size.width - size.right, size.top + size.plot];
  const grid = css("--line");
  const parts = [];
  for (const v of x.ticks) {
    parts.push(line([[x.at(v), size.top], [x.at(v), bottom]], grid, { "stroke-width": 1 }),
      text(tickLabel(v), { x: x.at(v).toFixed(1), y: bottom + 17, "text-anchor": "middle" }));
  }
  for (const v of y.ticks) {
    parts.push(line([[size.left, y.at(v)], [right, y.at(v)]], grid, { "stroke-width": 1 }),
      text(tickLabel(v), { x: size.left - 7, y: (y.at(v) + 4).toFixed(1), "text-anchor": "end" }));
  }
  const middle = size.top + size.plot / 2;
  return [...parts, line([[size.left, size.top], [size.left, bottom], [right, bottom]], css("--muted")),
    text(axisTitle(axis), { x: (size.left + right) / 2, y: bottom + 38, "text-anchor": "middle" }),
    text(axisTitle(metric), { x: 16, y: middle, "text-anchor": "middle",
      transform: `rotate(-90 16 ${middle})` })];
}

function legend(entries, top) {
  return entries.flatMap(({ symbol, label }, i) => {
    const y = top + i * size.line;
    return [symbol(size.left + 12, y), text(label, { x: size.left + 30, y: y + 4 })];
  });
}

/// `series` ([{name, rows}]) over the axes' keys `x` and `y`; null if there is nothing to show.
export function figureSvg(series, xKey, yKey) {
  const axis = axes.find((a) => a.key === xKey);
  const metric = metrics.find((m) => m.key === yKey);
  const curves = metric ? series.map((s) => points(s.rows, xKey, yKey)) : [];
  const all = curves.flat();
  if (all.length === 0) return null;
  const bottom = size.top + size.plot;
  const x = logAxis(all.map((p) => p.x), size.left, size.width - size.right);
  const y = logAxis(all.map((p) => p.y), bottom, size.top);
  const place = (p) => [x.at(p.x), y.at(p.y)];
  const entries = series.map(({ name }, i) => ({ label: name, symbol: (u, v) => mark(i, u, v, false) }));
  const slope = slopeLine(curves, metric.slope);
  const dashed = { "stroke-dasharray": "6 4", "stroke-width": 1 };
  if (slope.length > 0) {
    entries.push({ label: `slope ${slopeName(metric.slope)} (Monte Carlo)`,
      symbol: (u, v) => line([[u - 10, v], [u + 10, v]], css("--muted"), dashed) });
  }
  if (all.some((p) => p.floor)) {
    entries.push({ label: "at the reference's own noise", symbol: (u, v) => mark(0, u, v, true) });
  }
  const top = bottom + size.below + size.line / 2;
  const height = top + entries.length * size.line;
  const clip = svg("clipPath", { id: "plot" }, svg("rect", {
    x: size.left, y: size.top, width: size.width - size.left - size.right, height: size.plot }));
  return svg("svg", { viewBox: `0 0 ${size.width} ${height}`, width: size.width, height, role: "img",
    "aria-label": `${axisTitle(metric)} against ${axisTitle(axis)}`,
    "font-family": "DejaVu Sans, Helvetica, Arial, sans-serif" },
  clip, svg("rect", { width: size.width, height, fill: css("--surface") }), ...frame(x, y, axis, metric),
  svg("g", { "clip-path": "url(#plot)" }, line(slope.map(place), css("--muted"), dashed)),
  ...curves.flatMap((curve, i) => [line(curve.map(place), css(`--curve-${i % colours}`)),
    ...curve.map((p) => mark(i, ...place(p), p.floor))]),
  ...legend(entries, top));
}
