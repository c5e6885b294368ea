// Colours as style.css names them.
import { h } from "./dom.js";

const curves = 8;  // --curve-0 ...

/// What the names stand for now, light or dark: a function from a name to its colour.
export function inks() {
  const probe = h("span", { hidden: true });
  document.body.append(probe);
  const style = getComputedStyle(probe);
  const known = {};
  setTimeout(() => probe.remove());
  return (name) => {
    if (!known[name]) {
      probe.style.color = `var(${name})`;
      known[name] = style.color;
    }
    return known[name];
  };
}

/// The name of the i-th curve's colour; after eight they come again.
export const curveName = (i) => `--curve-${i % curves}`;

/// The turn in which a colour comes: curves of one colour need different marks.
export const round = (i) => Math.floor(i / curves);

/// Calls `redraw` when the reader turns from light to dark or back, until `signal` is aborted.
export const onColours = (redraw, signal) =>
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw, { signal });
