// How values become colours: exposure for colours, a range of a colour map for single channels.

/// As image.png is exposed: the 95th percentile of luminance becomes 0.8 of white. In stops, to a tenth.
const automatic = ({ extent: [, bright] }) => (bright > 0 ? Math.round(10 * Math.log2(0.8 / bright)) / 10 : 0);

/// The smallest of 1, 2 and 5 times a power of ten that is not below `value`.
function rounded(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].find((n) => n * power >= value) * power;
}

/// The values at the ends of the colour map, before the stops.
function range(images) {
  const high = Math.max(...images.map((image) => image.extent[1] ?? -Infinity));
  if (images[0].kind) {
    const top = high > 0 ? rounded(high) : 1;
    return images[0].kind === "signed" ? [-top, top] : [0, top];
  }
  const low = Math.min(...images.map((image) => image.extent[0] ?? Infinity));
  return Number.isFinite(high) && high > low ? [low, high]
    : [Math.min(0, Number.isFinite(low) ? low : 0), Math.max(1, high)];
}

/// What does not depend on the reader's choice: {look, ev} or {look, map, low, high}, for pictures
/// that are to be shown alike.
export function lookOf(images) {
  const [{ channels, kind }] = images;
  if (channels.length === 1) {
    const [low, high] = range(images);
    return { look: "false", map: kind === "signed" ? "diverging" : "sequential", low, high };
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
