// Errors by pixel: what a job's errors are the means of. A pixel's error is the mean over its
// channels, so the mean over the pixels is the error of the whole picture.
import { reader } from "./pixels.js";

/// x is the estimate, r the reference. `metric` is the key in curve.csv of the mean over the picture.
export const errorKinds = [
  { key: "signed", label: "signed error", formula: "x − r", of: (x, r) => x - r },
  { key: "absolute", label: "absolute error", formula: "|x − r|", metric: "mae",
    of: (x, r) => Math.abs(x - r) },
  { key: "squared", label: "squared error", formula: "(x − r)²", metric: "mse",
    of: (x, r) => (x - r) ** 2 },
  { key: "relative", label: "relative squared error", formula: "(x − r)² / (r² + 0.01)",
    metric: "relmse", of: (x, r) => (x - r) ** 2 / (r * r + 0.01) },
];

/// The power of two not above `largest`: it brings values into the range of a float.
const powerScale = (largest) => (largest === 0 ? 1 : 2 ** Math.floor(Math.log2(largest)));

/// A picture of one channel with the errors of `image` against `reference`, and their `mean`.
export function errorPicture(image, reference, kind) {
  if (image.width !== reference.width || image.height !== reference.height
    || image.channels.length !== reference.channels.length) {
    throw new Error(`These pictures cannot be compared: ${image.width} × ${image.height} and `
      + `${reference.width} × ${reference.height} pixels.`);
  }
  const [x, r] = [reader(image), reader(reference)];
  const { of } = kind;
  const n = image.channels.length;
  const values = new Float64Array(image.width * image.height);
  let sum = 0;
  let largest = 0;
  for (let i = 0, k = 0; i < values.length; i += 1) {
    let total = 0;
    for (let c = 0; c < n; c += 1, k += 1) total += of(x(k), r(k));
    const value = total / n;
    values[i] = value;
    sum += value;
    if (value > largest || -value > largest) largest = Math.abs(value);
  }
  const scale = powerScale(Number.isFinite(largest) ? largest : 1);
  const data = new Float32Array(values.length);
  for (let i = 0; i < data.length; i += 1) data[i] = values[i] / scale;
  return {
    width: image.width, height: image.height, channels: [kind.label], scale, data,
    mean: sum / values.length, kind,
  };
}
