// The values printed in the pixels of a magnified picture.
import { significant } from "./format.js";
import { valuesAt } from "./pixels.js";

const least = 48;  // CSS pixels that a pixel needs

const tints = { R: "#ff9a90", G: "#8fe29a", B: "#9cc4ff" };

function print(context, image, x, y, left, top, zoom) {
  const values = valuesAt(image, x, y);
  const line = Math.min(16, zoom / (values.length + 1), zoom / 5);
  context.font = `${0.8 * line}px ui-monospace, monospace`;
  context.lineWidth = 0.25 * line;
  values.forEach((value, c) => {
    const text = Number.isFinite(value) ? significant(value) : String(value);
    const at = [left + zoom / 2, top + zoom / 2 + (c - (values.length - 1) / 2) * line, zoom - 2];
    context.strokeText(text, ...at);
    context.fillStyle = tints[image.channels[c]] ?? "#ffffff";
    context.fillText(text, ...at);
  });
}

/// Prints into `canvas`, whose size is `box` (CSS pixels) times `ratio`. `corner` is the picture's
/// point in the upper left corner; `imageAt(u)` is the picture shown at that column of the frame.
export function printPixels(canvas, box, ratio, { corner, zoom, size, imageAt }) {
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, box.width, box.height);
  if (zoom < least) return;
  Object.assign(context, { textAlign: "center", textBaseline: "middle", strokeStyle: "#000000",
    lineJoin: "round" });
  const last = (from, room, length) => Math.min(length - 1, Math.floor(from + room / zoom));
  for (let y = Math.max(0, Math.floor(corner.y)); y <= last(corner.y, box.height, size.height); y += 1) {
    for (let x = Math.max(0, Math.floor(corner.x)); x <= last(corner.x, box.width, size.width); x += 1) {
      const left = (x - corner.x) * zoom;
      print(context, imageAt(left + zoom / 2), x, y, left, (y - corner.y) * zoom, zoom);
    }
  }
}
