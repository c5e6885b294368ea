// What of a viewer can be seen: two canvases over one another, the line between two pictures, the
// crop that is chosen, and the size of them all.
import { h } from "./dom.js";

/// `box()` is the frame's size in CSS pixels.
export function stage() {
  const canvas = h("canvas.pixels");
  const text = h("canvas.pixel-text", { "aria-hidden": "true" });
  const line = h("div.split-line", { hidden: true });
  const crop = h("div.crop-box", { hidden: true });
  const frame = h("div.stage", { tabIndex: 0, role: "group" }, canvas, text, line, crop);
  return {
    frame, canvas, text,
    /// The line of a state that splits, and the crop of one that has crops.
    mark(state, corner, zoom) {
      line.hidden = state.mode !== "split";
      line.style.left = `${100 * state.split}%`;
      crop.hidden = state.mode !== "crops";
      if (crop.hidden) return;
      const { x, y, w, h: high } = state.crop;
      const place = { left: (x - corner.x) * zoom, top: (y - corner.y) * zoom, width: w * zoom, height: high * zoom };
      for (const [name, value] of Object.entries(place)) crop.style[name] = `${value}px`;
    },
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
