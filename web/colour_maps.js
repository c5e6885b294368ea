// Colour maps for pictures of one channel, in OKLCH, where equal steps of the value look like equal steps
// of lightness. Each is a function from [0, 1] to lightness, chroma and hue.

export const steps = 256;

const maps = {
  /// Dark violet over red to pale yellow: for values from 0, or from a least one, up.
  sequential: (t) => [0.14 + 0.82 * t, 0.04 + 0.13 * Math.sin(Math.PI * t), 285 + 175 * t],
  /// Blue below, orange above, dark in the middle: for values of both signs.
  diverging: (t) => {
    const size = Math.abs(2 * t - 1);
    return [0.16 + 0.74 * size, 0.15 * Math.sin(0.5 * Math.PI * Math.min(1, 1.6 * size))
      * (1.15 - 0.45 * size), t < 0.5 ? 250 : 55];
  },
};

/// The map called `name`: `steps` colours, RGBA in bytes, sRGB.
export function colourMap(name) {
  const context = new OffscreenCanvas(steps, 1).getContext("2d", { willReadFrequently: true });
  for (let i = 0; i < steps; i += 1) {
    context.fillStyle = `oklch(${maps[name](i / (steps - 1)).join(" ")})`;
    context.fillRect(i, 0, 1, 1);
  }
  return context.getImageData(0, 0, steps, 1).data;
}
