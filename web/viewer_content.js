// What a viewer's state asks for, read and computed.
import { metrics } from "./curve.js";
import { errorKinds } from "./error_picture.js";
import { number, significant } from "./format.js";
import { lookOf } from "./look.js";
import { valuesAt } from "./pixels.js";
import { choices, errorOf, kindOf, pictureOf } from "./shown.js";

/// Makes `state` one that `sources` can show.
export function settle(state, sources) {
  const options = choices(sources);
  if (!options.some((o) => o.key === state.show)) state.show = options[0].key;
  state.left = Math.min(state.left, sources.length - 1);
  state.right = Math.min(state.right, Math.max(1, sources.length - 1));
  if (sources.length < 2) state.mode = "one";
  return options;
}

/// {images, shown, look, details}: a picture a source; the one shown where there is one; how they
/// look; and further pictures, with names, whose values are read with those of the one shown.
export async function contentOf(state, sources) {
  const images = await Promise.all(sources.map((s) => pictureOf(s, state.show)));
  const [left, right] = [images[state.left], images[state.right]];
  if (state.mode === "difference") {
    const kind = errorKinds.find((k) => k.key === state.by) ?? errorKinds[0];
    const shown = errorOf(right, left, kind);
    return { images, shown, look: lookOf([shown]), details: [["x", right], ["r", left]] };
  }
  const { layers } = sources[state.left];
  const details = state.mode === "one" && kindOf(state.show)
    ? [["x", await layers.read("")], ["r", await layers.read("reference")]] : [];
  return { images, shown: left, look: lookOf(images), details };
}

/// The parts of the frame from left to right: one picture, or two beside the line.
export function partsOf(state, { images, shown }) {
  if (state.mode !== "split") return [{ image: shown, from: 0, to: 1 }];
  return [{ image: images[state.left], from: 0, to: state.split },
    { image: images[state.right], from: state.split, to: 1 }];
}

/// "R 0.123  G 0.2  B 0.3"
function valueText(image, x, y) {
  const names = image.channels.length > 1 ? image.channels.map((name) => `${name} `) : [""];
  return valuesAt(image, x, y)
    .map((v, c) => names[c] + (Number.isFinite(v) ? significant(v, 4) : v)).join("  ");
}

/// A pixel's values, and a line for each of the details.
export function pixelText(image, details, x, y) {
  if (valuesAt(image, x, y) === null) return "outside";
  return [`(${x}, ${y})  ${valueText(image, x, y)}`,
    ...details.map(([name, of]) => `${name}: ${valueText(of, x, y)}`)].join("\n");
}

/// What a colour bar measures, with the mean: it is the error that the curve shows.
export function barTitle({ kind, mean }, layer) {
  if (!kind) return layer;
  const metric = metrics.find((m) => m.key === kind.metric);
  return `${kind.label}, ${kind.formula}; mean ${number(mean)}${metric ? ` (${metric.label})` : ""}`;
}
