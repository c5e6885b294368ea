// What a viewer can show of a job: its layers, and its errors against its reference.
import { errorKinds, kindOf } from "./error_picture.js";
import { errorOf } from "./errors.js";
import { words } from "./format.js";

const reference = "reference";
const errors = "error-";

/// The choices that all `sources` have: {key, label, group}. The picture itself has the key "".
export function choices(sources) {
  const shared = sources[0].layers.names.filter((name) =>
    sources.every((s) => s.layers.names.includes(name)));
  const layers = shared.map((key) => {
    const [group, ...name] = key.split(".");  // "strategies.s2t3"
    return { key, label: name.join(".") || key || "picture", group: name.length > 0 ? words(group) : "Layers" };
  });
  if (!shared.includes(reference)) return layers;
  return [...layers, ...errorKinds.map((kind) => ({
    key: errors + kind.key, label: kind.label, group: "Error against the reference",
  }))];
}

/// The key of the error that a choice means; undefined for a layer.
const errorIn = (key) => (key.startsWith(errors) ? kindOf(key.slice(errors.length))?.key : undefined);

/// The picture that a choice means for one source, and those that it was computed from, with names.
export async function pictureOf({ layers }, key) {
  const kind = errorIn(key);
  if (!kind) return { picture: (await layers.read(key))[0], from: [] };
  const [x, r] = await layers.read("", reference);
  return { picture: await errorOf(x, r, kind), from: [["x", x], ["r", r]] };
}
