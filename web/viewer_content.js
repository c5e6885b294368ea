// What a viewer's state asks for, read and computed.
import { settleCrop } from "./crop.js";
import { kindOf } from "./error_picture.js";
import { errorOf } from "./errors.js";
import { number, significant } from "./format.js";
import { metrics } from "./job_tables.js";
import { lookOf } from "./look.js";
import { valuesAt } from "./pixels.js";
import { choices, pictureOf } from "./shown.js";

/// Makes `state` one that `sources` can show.
export function settle(state, sources) {
  const options = choices(sources);
  if (!options.some((o) => o.key === state.show)) state.show = options[0].key;
  state.left = Math.min(state.left, sources.length - 1);
  state.right = Math.min(state.right, Math.max(1, sources.length - 1));
  if (sources.length < 2) state.mode = "one";
  if (state.mode === "crops") state.crop = settleCrop(state.crop, sources[0].layers);
  return options;
}

/// {images, shown, look, details}: the pictures of the sources that are needed; the one shown where
/// there is one; how they look; and further pictures, with names, whose values are read with those of
/// the one shown. The first is always needed, because its exposure is that of all; all of them are
/// where they share a range of values.
export async function contentOf(state, sources) {
  const read = (i) => pictureOf(sources[i], state.show);
  const first = await read(0);
  const all = state.mode === "crops" || first.picture.channels.length === 1;
  const found = await Promise.all(sources.map((_, i) =>
    (i === 0 ? first : all || i === state.left || (i === state.right && state.mode !== "one") ? read(i) : null)));
  const images = found.map((f) => f?.picture);
  const [left, right] = [images[state.left], images[state.right]];
  if (state.mode === "difference") {
    const shown = await errorOf(right, left, (kindOf(state.by) ?? kindOf("signed")).key);
    return { images, shown, look: lookOf([shown]), details: [["x", right], ["r", left]] };
  }
  return { images, shown: left, look: lookOf(images.filter(Boolean)),
    details: state.mode === "split" ? [] : found[state.left].from };
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
export function barTitle({ kind: key, mean }, layer) {
  if (!key) return layer;
  const kind = kindOf(key);
  const metric = metrics.find((m) => m.key === kind.metric);
  return `${kind.label}, ${kind.formula}; mean ${number(mean)}${metric ? ` (${metric.label})` : ""}`;
}
