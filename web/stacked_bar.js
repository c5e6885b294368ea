// Shares of a whole as one bar, with a legend that says the same in words.
import { h } from "./dom.js";
import { curveName } from "./palette.js";

/// `parts` are [{name, value, text}]; those without a value are only in the legend.
export function stackedBar(title, parts) {
  const total = parts.reduce((sum, p) => sum + p.value, 0);
  const percent = ({ value }) => (total > 0 ? (100 * value) / total : 0);
  const paint = (element, i) => {
    element.style.background = `var(${curveName(i)})`;
    return element;
  };
  const pieces = parts.map((part, i) => {
    const piece = paint(h("span", { title: `${part.name}: ${part.text}` }), i);
    piece.style.width = `${percent(part)}%`;
    return piece;
  });
  const entries = parts.map((part, i) => h("li", paint(h("span.swatch"), i),
    `${part.name} `, h("span.muted", `${part.text}, ${percent(part).toFixed(1)} %`)));
  return h("section.stacked", h("h3", title),
    h("div.stacked-bar", { "aria-hidden": "true" }, pieces), h("ul", entries));
}
