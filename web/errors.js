// Errors by pixel, computed by a worker. A pixel's error is the mean over its channels, so the mean over the pixels is
// the error of the whole picture.
import { extent } from "./pixels.js";

/// x is the estimate, r the reference. `metric` is the key in curve.csv of the mean over the picture.
export const errorKinds = [
  { key: "signed", label: "signed error", formula: "x − r", of: (x, r) => x - r },
  { key: "absolute", label: "absolute error", formula: "|x − r|", metric: "mae", of: (x, r) => Math.abs(x - r) },
  { key: "squared", label: "squared error", formula: "(x − r)²", metric: "mse", of: (x, r) => (x - r) ** 2 },
  { key: "relative", label: "relative squared error", formula: "(x − r)² / (r² + 0.01)",
    metric: "relmse", of: (x, r) => (x - r) ** 2 / (r * r + 0.01) },
];

export const kindOf = (key) => errorKinds.find((kind) => kind.key === key);

/// A picture of one channel with the errors (`key` is a kind's) of `image` against `reference`, and their `mean`.
export function errorPicture(image, reference, key) {
  if (image.data.length !== reference.data.length) throw new Error("These pictures differ in size.");
  const [x, r] = [image.data, reference.data];
  const { of, label } = kindOf(key);
  const n = image.channels.length;
  const values = new Float64Array(image.width * image.height);
  let sum = 0;
  let largest = 0;
  for (let i = 0, k = 0; i < values.length; i += 1) {
    let total = 0;
    for (let c = 0; c < n; c += 1, k += 1) total += of(x[k] * image.scale, r[k] * reference.scale);
    values[i] = total / n;
    sum += values[i];
    largest = Math.max(largest, Math.abs(values[i]) || 0);
  }
  // A power of two scales values into the range of a float.
  const scale = largest > 0 && Number.isFinite(largest) ? 2 ** Math.floor(Math.log2(largest)) : 1;
  const data = Float32Array.from(values, (value) => value / scale);
  const picture = { width: image.width, height: image.height, channels: [label], scale, data, mean: sum / values.length,
    kind: key };
  return { ...picture, extent: extent(picture) };
}

let worker = null;
function compute(image, reference, kind) {
  worker ??= new Worker("/error_worker.js", { type: "module" });
  const { port1, port2 } = new MessageChannel();
  return new Promise((resolve, reject) => {
    worker.addEventListener("error", () => {  // it could not be loaded: the next request starts another
      worker = null;
      reject(new Error("The errors could not be computed."));
    }, { once: true });
    port1.onmessage = ({ data: { picture, message } }) => (picture ? resolve(picture) : reject(new Error(message)));
    worker.postMessage({ image, reference, kind, port: port2 }, [port2]);
  });
}

const kept = new WeakMap();

/// Errors of one picture against another: a promise of errorPicture() for the key `kind`.
export function errorOf(image, reference, kind) {
  if (kept.get(image)?.reference !== reference) kept.set(image, { reference });
  const known = kept.get(image);
  known[kind] ??= compute(image, reference, kind).catch((error) => {
    delete known[kind];
    throw error;
  });
  return known[kind];
}
