// What a viewer can show of a job: its layers, and its errors against its reference.
import { errorKinds, errorPicture } from "./error_picture.js";

const reference = "reference";

/// The choices that all `sources` have: {key, label, group}. The picture itself has the key "".
export function choices(sources) {
  const shared = sources[0].layers.names.filter((name) =>
    sources.every((s) => s.layers.names.includes(name)));
  const layers = shared.map((key) => ({ key, label: key || "picture", group: "Layers" }));
  if (!shared.includes(reference)) return layers;
  return [...layers, ...errorKinds.map((kind) => ({
    key: `error-${kind.key}`, label: kind.label, group: "Error against the reference",
  }))];
}

/// The kind of error that a choice means; undefined for a layer.
export const kindOf = (key) => errorKinds.find((kind) => key === `error-${kind.key}`);

const kept = new WeakMap();

/// Errors of one picture against another, computed once.
export function errorOf(image, against, kind) {
  if (!kept.has(image)) kept.set(image, new Map());
  const known = kept.get(image);
  const found = known.get(kind.key);
  if (found?.against === against) return found.picture;
  const picture = errorPicture(image, against, kind);
  known.set(kind.key, { against, picture });
  return picture;
}

/// The picture that a choice means for one source.
export async function pictureOf({ layers }, key) {
  const kind = kindOf(key);
  if (!kind) return layers.read(key);
  const [image, against] = await Promise.all([layers.read(""), layers.read(reference)]);
  return errorOf(image, against, kind);
}
