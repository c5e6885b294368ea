// Lacuna's HTTP API of sweeps, as the page uses it.
import { json, send } from "./api.js";
import { shellQuote } from "./format.js";

const path = (id) => `/api/sweeps/${encodeURIComponent(id)}`;

/// All of them, newest first: [{id, label, state, created, run_count, counts, share}].
export const getSweeps = async (signal) => (await json("/api/sweeps", signal)).sweeps;
/// One with its file, cells and runs.
export const getSweep = (id, signal) => json(path(id), signal);
/// What its finished runs say (docs/sweeps-and-reports.md).
export const getAnswers = (id, signal) => json(`${path(id)}/answers`, signal);
export const tableUrl = (id) => `${path(id)}/table.csv`;
export const cancelSweep = (id) => send("POST", `${path(id)}/cancel`);
export const removeSweep = (id) => send("DELETE", path(id));

/// The command that posts a sweep file (an object) to this server.
export const sweepCurl = (spec) => `curl -sS -X POST ${location.origin}/api/sweeps `
  + `-H 'Content-Type: application/json' \\\n  -d ${shellQuote(JSON.stringify(spec))}`;
