// The error plot with its switches, as the job view, the comparison and the figure alone show it.
import { axes, presentMetrics } from "./curve.js";
import { addressOf, h, labelledSelect, remember, small } from "./dom.js";
import { saveFigure } from "./figure_file.js";
import { figureSvg } from "./figure_svg.js";
import { metrics } from "./job_tables.js";
import { plot } from "./plot.js";

/// A plot and its switches. `query` (URLSearchParams) holds the choice, `x` and `y`; the switches change
/// it and the address, and then `changed()` is called. `show(series, preferred)` draws what `query` says:
/// else the metric `preferred`, else the first that all of them have. After it, `x` and `y` say what is
/// shown; `y` is null if there is nothing.
export function curvePanel(query, signal, changed = () => {}) {
  const figure = plot(signal);
  const choose = (key) => (value) => {
    query.set(key, value);
    draw();
    remember(query);
    changed();
  };
  const x = labelledSelect("against", choose("x"));
  const y = labelledSelect("Error", choose("y"));
  const save = (kind) => small(`Save as ${kind}`, () => saveFigure(figureSvg(shown, panel.x, panel.y),
    `lacuna-${panel.y}.${kind.toLowerCase()}`));
  const embedded = query.has("embed");
  const alone = small(embedded ? "Leave the figure" : "Figure alone", () => {
    if (embedded) query.delete("embed");
    else query.set("embed", "");
    location.hash = addressOf(query);
  });
  const switches = h("div.switches", y.element, x.element,
    h("span.tools", alone, save("SVG"), save("PNG")));
  let shown = [];
  let wanted = null;

  function draw() {
    const has = shown.map(({ rows }) => presentMetrics(rows));
    const offered = metrics.filter((m) => has.some((present) => present.includes(m)));
    const pick = (key) => offered.find((m) => m.key === key);
    const metric = pick(query.get("y")) ?? pick(wanted)
      ?? offered.find((m) => has.every((present) => present.includes(m))) ?? offered[0];
    panel.x = (axes.find((a) => a.key === query.get("x")) ?? axes[0]).key;
    panel.y = metric?.key ?? null;
    switches.hidden = panel.y === null;
    x.fill(axes, panel.x);
    y.fill(offered, panel.y);
    figure.draw(shown, panel.x, panel.y);
  }

  const panel = {
    element: h("div", switches, figure.element),
    x: axes[0].key,
    y: null,
    show(series, preferred = null) {
      [shown, wanted] = [series, preferred];
      draw();
    },
  };
  return panel;
}
