// What differs between job files.

/// "/integrator/max_depth": 6, ... for every leaf of a job file; arrays count as leaves.
export function leaves(value, pointer = "", into = {}) {
  if (value !== null && typeof value === "object" && !Array.isArray(value)) {
    for (const [key, child] of Object.entries(value)) leaves(child, `${pointer}/${key}`, into);
  } else {
    into[pointer] = JSON.stringify(value);
  }
  return into;
}

/// The pointers whose values are not the same in all jobs, each with a value per job ("" where a
/// job has none).
export function differences(jobs) {
  const all = jobs.map((job) => leaves(job));
  const pointers = [...new Set(all.flatMap((l) => Object.keys(l)))];
  return pointers
    .filter((p) => all.some((l) => l[p] !== all[0][p]))
    .map((pointer) => ({ pointer, values: all.map((l) => l[pointer] ?? "") }));
}

/// What must be the same for errors to be comparable. Longer paths and another environment make
/// another picture, so they belong here too.
const sameForComparison = [
  "/scene", "/camera", "/resolution", "/integrator/max_depth", "/reference", "/environment",
];

/// Those of `differences` that make a comparison of errors doubtful.
export const doubtful = (found) => found.map((d) => d.pointer).filter((pointer) =>
  sameForComparison.some((p) => pointer === p || pointer.startsWith(`${p}/`)));
