// Jobs as curves: read with their files, and named so that no two read the same.
import { getJob, getText, poll } from "./api.js";
import { parseCurve } from "./curve.js";
import { integratorName, jobTitle } from "./format.js";
import { isTerminal } from "./status.js";

const everyMs = 5000;

/// A job with its curve and its report. One that has ended is read once.
async function readJob(id, before, signal) {
  if (before && isTerminal(before.state.state)) return before;
  const job = await getJob(id, signal);
  const has = (name) => job.files.find((f) => f.name === name);
  const rows = has("curve.csv") ? parseCurve(await getText(id, "curve.csv", signal)) : [];
  const report = has("report.json") ? JSON.parse(await getText(id, "report.json", signal)) : null;
  return { ...job, rows, report };
}

/// "label, integrator"; where two would read the same, with the end of the id.
function names(jobs) {
  const plain = jobs.map(({ job }) => `${jobTitle(job)}, ${integratorName(job.integrator)}`);
  return jobs.map(({ id }, i) => (plain.filter((n) => n === plain[i]).length > 1
    ? `${plain[i]} (${id.split("-").pop()})` : plain[i]));
}

/// The error metric in which all jobs report their progress; null if they differ.
function reportedMetric(jobs) {
  const reported = new Set(jobs.map(({ progress }) => progress?.error_metric));
  return reported.size === 1 ? [...reported][0] : null;
}

/// Reads the jobs, again while any of them goes on, and each time calls `draw` with {jobs, series,
/// preferred, problems}: those that could be read, their curves as {name, rows}, the metric to show,
/// and what is wrong with the others.
export function followJobs(ids, draw, signal) {
  const read = new Map();
  return poll(async () => {
    const results = await Promise.allSettled(ids.map((id) => readJob(id, read.get(id), signal)));
    signal.throwIfAborted();
    results.forEach(({ value }, i) => value && read.set(ids[i], value));
    const jobs = ids.map((id) => read.get(id)).filter(Boolean);
    const labels = names(jobs);
    draw({
      jobs, preferred: reportedMetric(jobs), series: jobs.map(({ rows }, i) => ({ name: labels[i], rows })),
      problems: results.flatMap(({ reason }, i) => (reason ? [`${ids[i]}: ${reason.message}`] : [])),
    });
    return jobs.some((job) => !isTerminal(job.state.state));
  }, everyMs, signal);
}

export const idsOf = (query) => [...new Set((query.get("jobs") ?? "").split(",").filter(Boolean))];
