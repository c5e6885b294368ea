// Jobs as curves: read with their files, and named so that no two read the same.
import { getJob, getText, isTerminal } from "./api.js";
import { parseCurve } from "./curve.js";
import { integratorName, jobTitle } from "./format.js";

/// A job with its curve. One that has ended is read once.
export async function readJob(id, before, signal) {
  if (before && isTerminal(before.state.state)) return before;
  const job = await getJob(id, signal);
  const has = (name) => job.files.find((f) => f.name === name);
  const rows = has("curve.csv") ? parseCurve(await getText(id, "curve.csv", signal)) : [];
  return { ...job, rows };
}

/// "label, integrator"; where two would read the same, with the end of the id.
export function names(jobs) {
  const plain = jobs.map(({ job }) => `${jobTitle(job)}, ${integratorName(job.integrator)}`);
  return jobs.map(({ id }, i) => (plain.filter((n) => n === plain[i]).length > 1
    ? `${plain[i]} (${id.split("-").pop()})` : plain[i]));
}

/// The error metric in which all jobs report their progress; null if they differ.
export function reportedMetric(jobs) {
  const reported = new Set(jobs.map(({ progress }) => progress?.error_metric));
  return reported.size === 1 ? [...reported][0] : null;
}

export const idsOf = (query) => [...new Set((query.get("jobs") ?? "").split(",").filter(Boolean))];
