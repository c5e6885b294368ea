// Figures: curves over log axes as SVG in the page's colours, on the page and as files (of papers: paper_figure.js).
import { slopeLine, slopeName } from "./curve.js";
import { h, note, save, small } from "./dom.js";
import { number } from "./format.js";

const size = { left: 68, right: 14, top: 14, plot: 360, below: 52, line: 18, column: 320, letter: 6.6 };
const narrowest = 280;
export const colours = 8;
/// The i-th curve's colour, named in style.css; eight colours repeat.
export const curveColour = (i) => `var(--curve-${i % colours})`;
const grid = "var(--line)";
const muted = "var(--muted)";

/// Ticks of a log axis: decades, and as many steps between them as fit.
export function logTicks(min, max) {
  const decades = Math.log10(max / min);
  if (!(decades > 0)) return [min];
  if (decades < 0.7) {
    const rough = (max - min) / 4;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 5, 10].find((n) => n * power >= rough);
    const count = Math.floor(max / step) - Math.ceil(min / step) + 1;
    return Array.from({ length: count }, (_, i) => (Math.ceil(min / step) + i) * step);
  }
  const parts = decades > 3 ? [1] : decades > 1.5 ? [1, 3] : [1, 2, 5];
  const every = Math.ceil(decades / 8);
  const first = Math.floor(Math.log10(min));
  return Array.from({ length: Math.floor(Math.log10(max)) - first + 1 }, (_, i) => first + i)
    .filter((e) => e % every === 0).flatMap((e) => parts.map((part) => Number(`${part}e${e}`)))
    .filter((value) => value >= min && value <= max);
}

function tickLabel(value) {
  const large = Math.abs(value);
  return large >= 1e-3 && large < 1e5 ? String(Number(value.toPrecision(3)))
    : value.toExponential().replace("e+", "e");
}

/// An axis that includes `values`: `at(value)` is a position; `ticks` are at least `apart` from each other.
function logAxis(values, from, to, apart) {
  const [min, max] = [Math.min(...values) / 1.15, Math.max(...values) * 1.15];
  const at = (v) => from + ((to - from) * Math.log(v / min)) / Math.log(max / min);
  const ticks = [];
  for (const v of logTicks(min, max)) {
    if (ticks.length === 0 || Math.abs(at(v) - at(ticks.at(-1))) >= apart) ticks.push(v);
  }
  return { at, ticks };
}

/// An SVG element with attributes; never with `style`, which the page's policy forbids.
export function svg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

const axisTitle = ({ label, unit }) => (unit ? `${label} (${unit})` : label);
const text = (content, attributes) => svg("text", { fill: "var(--text)", "font-size": 12, ...attributes }, content);
const joined = (places) => places.map(([x, y]) => `${x.toFixed(2)},${y.toFixed(2)}`).join(" ");
const line = (places, stroke, more = {}) =>
  svg("polyline", { points: joined(places), fill: "none", stroke, "stroke-width": 1.5, ...more });
const dashed = { "stroke-dasharray": "6 4", "stroke-width": 1 };
const thick = { "stroke-width": 9, "stroke-opacity": 0.3, "stroke-linecap": "round" };
const thin = { "stroke-width": 0.7 };

/// Marks that are distinguishable without colours.
const marks = [
  (x, y, r) => svg("circle", { cx: x, cy: y, r }),
  (x, y, r) => svg("rect", { x: x - r, y: y - r, width: 2 * r, height: 2 * r }),
  (x, y, r) => svg("path", { d: `M${x} ${y - 1.2 * r}l${1.2 * r} ${2.2 * r}h${-2.4 * r}z` }),
  (x, y, r) => svg("path", { d: `M${x} ${y - 1.4 * r}l${1.4 * r} ${1.4 * r}l${-1.4 * r} ${1.4 * r}`
    + `l${-1.4 * r} ${-1.4 * r}z` }),
];

/// The mark of the i-th curve; curves of one colour have different ones.
function mark(i, [x, y], hollow) {
  const shape = marks[(i + Math.floor(i / colours)) % marks.length](Number(x.toFixed(2)), Number(y.toFixed(2)), 3.2);
  shape.setAttribute("stroke", curveColour(i));
  shape.setAttribute("fill", hollow ? "var(--surface)" : curveColour(i));
  return shape;
}

function frame(width, x, y, axis, metric) {
  const [right, bottom] = [width - size.right, size.top + size.plot];
  const middle = size.top + size.plot / 2;
  const rule = (...places) => line(places, grid, { "stroke-width": 1 });
  return [
    ...x.ticks.flatMap((v) => [rule([x.at(v), size.top], [x.at(v), bottom]),
      text(tickLabel(v), { x: x.at(v).toFixed(1), y: bottom + 17, "text-anchor": "middle" })]),
    ...y.ticks.flatMap((v) => [rule([size.left, y.at(v)], [right, y.at(v)]),
      text(tickLabel(v), { x: size.left - 7, y: (y.at(v) + 4).toFixed(1), "text-anchor": "end" })]),
    line([[size.left, size.top], [size.left, bottom], [right, bottom]], muted),
    text(axisTitle(axis), { x: (size.left + right) / 2, y: bottom + 38, "text-anchor": "middle" }),
    text(axisTitle(metric), { x: 14, y: middle, "text-anchor": "middle", transform: `rotate(-90 14 ${middle})` })];
}

/// The entries [label, symbol(place)] in columns below the plot, with long names truncated, and their height.
function legend(width, entries, top) {
  const columns = Math.max(1, Math.min(Math.floor((width - 30) / size.column), Math.ceil(entries.length / 4)));
  const rows = Math.ceil(entries.length / columns);
  const room = (width - 20) / columns;
  const letters = Math.floor((room - 40) / size.letter);
  const parts = entries.flatMap(([label, symbol], i) => {
    const [x, y] = [20 + room * Math.floor(i / rows), top + (i % rows) * size.line];
    const words = text(label.length > letters ? `${label.slice(0, letters - 1)}…` : label, { x: x + 18, y: y + 4 });
    if (label.length > letters) words.append(svg("title", {}, label));
    return [symbol([x, y]), words];
  });
  return { parts, height: rows * size.line };
}

/// A curve with its interval, if any, and marks with their values as tooltips.
function markedCurve({ name, points, index }, place, axis, metric) {
  const colour = curveColour(index);
  const edge = (key) => points.map((p) => place({ x: p.x, y: p[key] ?? p.y }));
  const band = points.some((p) => p.low < p.high) ? [svg("polygon", { fill: colour, "fill-opacity": 0.15,
    stroke: "none", points: joined([...edge("high"), ...edge("low").toReversed()]) })] : [];
  const told = points.map((p) => {
    const interval = p.low < p.high ? ` (${number(p.low)} to ${number(p.high)})` : "";
    const shape = mark(index, place(p), p.floor);
    shape.append(svg("title", {}, `${name}: ${metric.label} ${number(p.y)}${interval} at ${number(p.x)} `
      + `${axis.unit || axis.label}${p.floor ? ", at the reference's noise" : ""}`));
    return shape;
  });
  return svg("g", { class: "curve" }, ...band, line(points.map(place), colour), ...told);
}

/// The legend of a figure: curves with an index, and lines that need an explanation.
function entriesOf({ curves, front = [], metric }, slope) {
  const stroke = (half, how) => ([u, v]) => line([[u - half, v], [u + half, v]], muted, how);
  const named = curves.filter((c) => c.index !== undefined);
  const more = curves.length - named.length;
  return [
    ...named.map((c) => [c.name, (at) => mark(c.index, at, false)]),
    front.length > 0 && ["lowest mean error (the front)", stroke(8, thick)],
    more > 0 && [`${more} more`, stroke(10, thin)],
    slope.length > 0 && [`slope ${slopeName(metric.slope)} (Monte Carlo)`, stroke(10, dashed)],
    named.some((c) => c.points.some((p) => p.floor))
      && ["hollow: at the reference's own noise", (at) => mark(0, at, true)],
  ].filter(Boolean);
}

/// `curves` are [{name, points: [{x, y, low, high, floor}], index}]: thin, or with an index in its colour with marks
/// and a band. `front` are lists of points, drawn thick; `axis` and `metric` are {label, unit, slope}. null: empty.
export function figureSvg({ curves, front = [], axis, metric }, width = 720) {
  const all = curves.flatMap((c) => c.points);
  if (all.length === 0) return null;
  const bottom = size.top + size.plot;
  const x = logAxis([...all, ...front.flat()].map((p) => p.x), size.left, width - size.right, 48);
  const y = logAxis(all.map((p) => p.y), bottom, size.top, 20);
  const place = (p) => [x.at(p.x), y.at(p.y)];
  const slope = metric.slope ? slopeLine(curves.map((c) => c.points), metric.slope) : [];
  const top = bottom + size.below + size.line / 2;
  const names = legend(width, entriesOf({ curves, front, metric }, slope), top);
  const height = top + names.height;
  return svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img",
    "aria-label": `${axisTitle(metric)} against ${axisTitle(axis)}`,
    "font-family": "DejaVu Sans, Helvetica, Arial, sans-serif" },
  svg("clipPath", { id: "plot" }, svg("rect", {
    x: size.left, y: size.top, width: width - size.left - size.right, height: size.plot })),
  svg("rect", { width, height, fill: "var(--surface)" }), ...frame(width, x, y, axis, metric),
  svg("g", { "clip-path": "url(#plot)" },
    line(slope.map(place), muted, dashed),
    ...front.map((part) => line(part.map(place), muted, { ...thick, class: "front" })),
    ...curves.filter((c) => c.index === undefined).map((c) => line(c.points.map(place), muted, thin)),
    ...curves.filter((c) => c.index !== undefined).map((c) => markedCurve(c, place, axis, metric))),
  ...names.parts);
}

/// A container for a figure, as wide as available. `draw(what)` shows figureSvg() of it, or `empty`. `saveButton(what,
/// name)` is a button that saves it: `what` is in its text, `name()` is the file name.
export function figureBox(empty) {
  const box = h("div.plot");
  let shown = null;
  let width = 0;

  function redraw() {
    if (shown && width > 0) box.replaceChildren(figureSvg(shown, Math.max(narrowest, width)) ?? note(empty));
  }
  new ResizeObserver(([entry]) => {
    const now = Math.floor(entry.contentRect.width);
    if (now === width) return;
    width = now;
    redraw();
  }).observe(box);
  return {
    element: h("figure", box),
    draw(next) {
      shown = next;
      // For tests: the numbers of curves and points.
      box.dataset.curves = shown.curves.filter((c) => c.points.length > 0).length;
      box.dataset.points = shown.curves.flatMap((c) => c.points).length;
      redraw();
    },
    saveButton: (what, name) => small(`Save ${what}as SVG`, () => saveFigure(figureSvg(shown), `${name()}.svg`)),
  };
}

/// Saves an SVG element, in the page's present colours.
function saveFigure(figure, name) {
  const page = getComputedStyle(document.documentElement);
  const now = matchMedia("(prefers-color-scheme: dark)").matches ? 1 : 0;
  // A name's value is light-dark(#..., #...).
  const source = new XMLSerializer().serializeToString(figure)
    .replace(/var\((--[\w-]+)\)/g, (_, colour) => page.getPropertyValue(colour).match(/#\w+/g)[now]);
  save(new Blob([source], { type: "image/svg+xml" }), name);
}
