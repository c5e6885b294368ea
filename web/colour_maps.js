// Colour maps for pictures of one channel, made in OKLab (Ottosson 2020) so that equal steps of the
// value look like equal steps of lightness.

export const steps = 256;

function linearRgb(lightness, a, b) {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
}

function encode(linear) {
  const v = Math.min(1, Math.max(0, linear));
  return Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
}

function colour(lightness, chroma, degrees) {
  const angle = (degrees * Math.PI) / 180;
  return linearRgb(lightness, chroma * Math.cos(angle), chroma * Math.sin(angle)).map(encode);
}

const maps = {
  /// Dark violet over red to pale yellow: for values from 0, or from a least one, up.
  sequential: (t) => colour(0.14 + 0.82 * t, 0.04 + 0.13 * Math.sin(Math.PI * t), 285 + 175 * t),
  /// Blue below, orange above, dark in the middle: for values of both signs.
  diverging: (t) => {
    const size = Math.abs(2 * t - 1);
    return colour(0.16 + 0.74 * size, 0.15 * Math.sin(0.5 * Math.PI * Math.min(1, 1.6 * size))
      * (1.15 - 0.45 * size), t < 0.5 ? 250 : 55);
  },
};

/// The map called `name`: `steps` colours, RGBA in bytes, sRGB.
export function colourMap(name) {
  const bytes = new Uint8Array(4 * steps);
  for (let i = 0; i < steps; i += 1) bytes.set([...maps[name](i / (steps - 1)), 255], 4 * i);
  return bytes;
}
