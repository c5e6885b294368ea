// What differs between job files.
import { leaves } from "./report.js";

/// "/integrator/max_depth" -> 6, ... for every value of a job file.
const settings = (job) => new Map(leaves(job).map(({ keys, value }) =>
  [`/${keys.toReversed().join("/")}`, JSON.stringify(value)]));

/// The pointers whose values are not the same in all jobs, each with a value per job ("" where a
/// job has none).
export function differences(jobs) {
  const all = jobs.map(settings);
  return [...new Set(all.flatMap((one) => [...one.keys()]))]
    .map((pointer) => ({ pointer, values: all.map((one) => one.get(pointer) ?? "") }))
    .filter(({ values }) => values.some((value) => value !== values[0]));
}

/// What must be the same for errors to be comparable. Longer paths and another environment make
/// another picture, so they belong here too.
const sameForComparison = [
  "/scene", "/camera", "/resolution", "/integrator/max_depth", "/reference", "/environment", "/particles", "/material",
];

/// Those of `differences` that make a comparison of errors doubtful.
export const doubtful = (found) => found.map((d) => d.pointer).filter((pointer) =>
  sameForComparison.some((p) => pointer === p || pointer.startsWith(`${p}/`)));
