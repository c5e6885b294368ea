// How values become colours: exposure for colours, a range of a colour map for single channels.
import { quantile } from "./pixels.js";

const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

/// As image.png is exposed: the 95th percentile of luminance becomes 0.8 of white. In stops, to a tenth.
function automatic(image) {
  const bright = quantile(image, 0.95, (v) => Math.max(0, luminance(v)));
  return bright === null ? 0 : Math.round(10 * Math.log2(0.8 / bright)) / 10;
}

/// The smallest of 1, 2 and 5 times a power of ten that is not below `value`.
function rounded(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].find((n) => n * power >= value) * power;
}

/// The values at the ends of the colour map, before the stops: of errors, up to 99.5 % of all
/// pixels; of other layers, the least and the largest value.
function range(images) {
  const of = (q, f) => Math.max(...images.map((image) => quantile(image, q, f) ?? -Infinity));
  if (images[0].kind) {
    const top = of(0.995, ([v]) => Math.abs(v));
    const high = top > 0 ? rounded(top) : 1;
    return images[0].kind.key === "signed" ? [-high, high] : [0, high];
  }
  const high = of(1, ([v]) => v);
  const low = -of(1, ([v]) => -v);
  return Number.isFinite(high) && high > low ? [low, high] : [Math.min(0, low || 0), Math.max(1, high)];
}

/// What does not depend on the reader's choice: {look, ev} or {look, map, low, high}, for pictures
/// that are to be shown alike.
export function lookOf(images) {
  const [{ channels, kind }] = images;
  if (channels.length === 1) {
    const [low, high] = range(images);
    return { look: "false", map: kind?.key === "signed" ? "diverging" : "sequential", low, high };
  }
  if (channels.join("") === "XYZ") return { look: "direction" };
  return { look: "colour", ev: automatic(images[0]) };
}

/// A look with the reader's exposure: what the painter needs, and for a false colour its `low` and
/// `high` end. `ev` null: the look's own. One stop up shows values half as large as brightly.
export function exposed(look, { ev, stops }) {
  if (look.look === "colour") return { ...look, gain: 2 ** (ev ?? look.ev), offset: 0 };
  if (look.look === "direction") return { ...look, gain: 0.5, offset: 0.5 };
  const span = (look.high - look.low) * 2 ** -stops;
  const low = look.map === "diverging" ? -span / 2 : look.low;
  return { ...look, low, high: low + span, gain: 1 / span, offset: -low / span };
}
