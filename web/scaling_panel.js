// The scaling figure of compared jobs with its switches.
import { h, labelledSelect, note, remember, small } from "./dom.js";
import { saveFigure } from "./figure_file.js";
import { figureBox } from "./plot.js";
import { quantities, scalingCurves } from "./scaling.js";
import { scalingSvg } from "./scaling_svg.js";

const first = "seconds render_cpu";

/// A figure and its switches; `query` holds the choice, `sx` and `sy`. `show(jobs)` draws jobs with their
/// reports; the panel is hidden while there is nothing in which they differ.
export function scalingPanel(query, signal) {
  const figure = figureBox("No report contains both quantities.", signal);
  const choose = (key) => (value) => {
    query.set(key, value);
    draw();
    remember(query);
  };
  const y = labelledSelect("Number", choose("sy"));
  const x = labelledSelect("over", choose("sx"));
  const save = (kind) => small(`Save scaling as ${kind}`, () => saveFigure(make(), `lacuna-scaling.${kind.toLowerCase()}`));
  const element = h("section", h("h2", "Scaling"),
    h("div.switches", y.element, x.element, h("span.tools", save("SVG"), save("PNG"))), figure.element,
    note("The exponent of a power law of x, fitted to the logarithms of each curve."));
  let jobs = [];
  let make = () => null;

  function draw() {
    const offered = quantities(jobs);
    element.hidden = offered.x.length === 0 || offered.y.length === 0;
    if (element.hidden) return;
    const pick = (of, key, other) => of.find((q) => q.key === query.get(key)) ?? of.find((q) => q.key === other) ?? of[0];
    const [over, what] = [pick(offered.x, "sx"), pick(offered.y, "sy", first)];
    x.fill(offered.x.map(({ values, ...q }) => q), over.key);
    y.fill(offered.y.map(({ values, group, ...q }) => q), what.key);
    const curves = scalingCurves(jobs, over, what);
    make = (width) => scalingSvg(curves, over.label, what.label, width);
    figure.draw(make, curves.length, curves.flatMap((c) => c.points).length);
  }

  element.hidden = true;
  return {
    element,
    show(next) {
      jobs = next;
      draw();
    },
  };
}
