// What of a viewer can be seen: two canvases over one another, the line between two pictures, and
// the size of them all.
import { h } from "./dom.js";

/// `box()` is the frame's size in CSS pixels.
export function stage() {
  const canvas = h("canvas", { className: "pixels" });
  const text = h("canvas", { className: "pixel-text", "aria-hidden": "true" });
  const line = h("div", { className: "split-line", hidden: true });
  const frame = h("div", { className: "stage", tabIndex: 0, role: "group" }, canvas, text, line);
  return {
    frame, canvas, text, line,
    box: () => ({ width: Math.max(1, frame.clientWidth), height: Math.max(1, frame.clientHeight) }),
    setSize({ width, height }) {
      frame.style.setProperty("--aspect", Math.min(4, Math.max(0.5, width / height)));
    },
    /// The canvases' size follows the frame's, in the screen's own pixels.
    fitCanvases({ width, height }, ratio) {
      const size = [Math.round(width * ratio), Math.round(height * ratio)];
      for (const one of [canvas, text]) {
        if (one.width !== size[0] || one.height !== size[1]) [one.width, one.height] = size;
      }
    },
  };
}
