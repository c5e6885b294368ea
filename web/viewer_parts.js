// The visible parts of a viewer: canvases, values printed in magnified pixels, the colour bar, and the crops.
import { aboutTimes } from "./curve.js";
import { h, note, replace, update } from "./dom.js";
import { seconds, significant } from "./format.js";
import { colourMap, steps, stripPainter } from "./paint.js";
import { cut, valuesAt } from "./pixels.js";
import { longest } from "./viewport.js";

/// `box()` is the frame's size in CSS pixels.
export function stage() {
  const canvas = h("canvas.pixels");
  const text = h("canvas.pixel-text", { "aria-hidden": "true" });
  const line = h("div.split-line", { hidden: true });
  const crop = h("div.crop-box", { hidden: true });
  const frame = h("div.stage", { tabIndex: 0, role: "group" }, canvas, text, line, crop);
  return {
    frame, canvas, text,
    /// Shows the line of a split, and the crop of a state with crops.
    mark({ mode, split, crop: chosen }, corner, zoom) {
      line.hidden = mode !== "split";
      line.style.left = `${100 * split}%`;
      crop.hidden = mode !== "crops";
      if (crop.hidden) return;
      const { x, y, w, h: high } = chosen;
      const place = { left: (x - corner.x) * zoom, top: (y - corner.y) * zoom, width: w * zoom, height: high * zoom };
      for (const [name, value] of Object.entries(place)) crop.style[name] = `${value}px`;
    },
    box: () => ({ width: Math.max(1, frame.clientWidth), height: Math.max(1, frame.clientHeight) }),
    setSize: ({ width, height }) => frame.style.setProperty("--aspect", Math.min(4, Math.max(0.5, width / height))),
    /// Resizes the canvases to the frame, in device pixels.
    fitCanvases(box, ratio) {
      const [width, height] = [box.width, box.height].map((n) => Math.round(n * ratio));
      if (canvas.width === width && canvas.height === height) return;
      for (const one of [canvas, text]) Object.assign(one, { width, height });
    },
  };
}

const least = 48;  // CSS pixels per pixel for printed values
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
  Object.assign(context, { textAlign: "center", textBaseline: "middle", strokeStyle: "#000000", lineJoin: "round" });
  const last = (from, room, length) => Math.min(length - 1, Math.floor(from + room / zoom));
  for (let y = Math.max(0, Math.floor(corner.y)); y <= last(corner.y, box.height, size.height); y += 1) {
    for (let x = Math.max(0, Math.floor(corner.x)); x <= last(corner.x, box.width, size.width); x += 1) {
      const left = (x - corner.x) * zoom;
      print(context, imageAt(left + zoom / 2), x, y, left, (y - corner.y) * zoom, zoom);
    }
  }
}

/// A colour map with the values it stands for; `show(look, title)` hides it unless the colours are false.
export function colourBar() {
  const canvas = h("canvas", { width: steps, height: 1, role: "img" });
  const [title, labels] = [h("span.bar-title"), h("div.bar-labels")];
  const element = h("div.colour-bar", title, canvas, labels);
  return {
    element,
    show(look, text) {
      element.hidden = look.look !== "false";
      if (element.hidden) return;
      const values = [0, 1, 2, 3, 4].map((i) => significant(look.low + ((look.high - look.low) * i) / 4));
      update(title, text);
      update(labels, values.map((value) => h("span", value)));
      canvas.ariaLabel = `Colours from ${values[0]} to ${values[4]}`;
      canvas.getContext("2d").putImageData(new ImageData(colourMap(look.map).bytes, steps, 1), 0, 0);
    },
  };
}

/// One crop of several jobs side by side, at one exposure, with each job's time and error, if the state requires it;
/// `ratio`: device pixels per CSS pixel.
export function cropStrip(signal) {
  const draw = stripPainter(signal);
  const [title, times, strip] = [note(), h("div"), h("div.crops")];
  const element = h("section", { hidden: true }, h("h3", "Crops"), title, times, strip);
  let shown = {};
  let canvases = [];

  return {
    element,
    show({ mode, crop }, sources, images, look, ratio) {
      element.hidden = mode !== "crops" || images.includes(undefined);
      if (element.hidden) return;
      const now = JSON.stringify([crop, look, ratio]);
      if (shown.images === images && shown.now === now) return;
      if (shown.sources !== sources) {
        canvases = sources.map(({ name }) => h("canvas", { role: "img", "aria-label": `Crop of ${name}` }));
        replace(strip, sources.map((s, i) => h("figure", canvases[i],
          h("figcaption", h("span", s.name), h("span", `${seconds(s.seconds)}, ${s.error || "no error measured"}`)))));
        replace(times, aboutTimes(sources.map((s) => s.seconds ?? 0)));
      }
      shown = { sources, images, now };
      const zoom = Math.max(1, Math.floor(longest / Math.max(crop.w, crop.h)));
      update(title, `${crop.w} × ${crop.h} pixels at (${crop.x}, ${crop.y}), ${zoom} times as large. `
        + `Drag over the picture to choose others, at most ${longest} a side.`);
      const wide = crop.w * zoom;
      draw(images.map((image, i) => ({ image: cut(image, crop), canvas: canvases[i], wide })), look, ratio);
    },
  };
}
