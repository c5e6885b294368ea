// What differs between job files.
import { inTheLight, notInAReference } from "./job_tables.js";
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

/// Whether jobs that differ there may estimate different pictures. A setting that this page has never heard of
/// counts: left out is only what the program's table names.
const isOfThePicture = (pointer) => inTheLight.includes(pointer) || !notInAReference.includes(pointer.split("/")[1]);

/// Those of `differences` that make a comparison of errors doubtful.
export const doubtful = (found) => found.map((d) => d.pointer).filter(isOfThePicture);
