// Lacuna's HTTP API as the page uses it: requests, problems, polling and events.
import { ask, h, update } from "./dom.js";
import { shellQuote } from "./format.js";

/// A failed request: problem+json, or `status` 0 without a response.
export class ApiError extends Error {
  constructor(status, problem) {
    super(problem.detail || problem.title);
    this.status = status;
    this.title = problem.title;
    this.errors = problem.errors ?? [];
  }
}

const noAnswer = "The server does not answer; trying again.";
const retryMs = 2000;
const session = "/api/session";

async function request(path, options = {}) {
  const response = await fetch(path, options).catch((error) => {
    throw options.signal?.aborted ? error : new ApiError(0, { title: "The server does not answer",
      detail: `No answer from ${location.origin}. Is lacuna-server running?` });
  });
  if (response.ok) return response;
  if (response.status === 401 && path !== session && await signIn()) return request(path, options);
  const fallback = { title: `Error ${response.status}`, detail: response.statusText };
  throw new ApiError(response.status, await response.json().catch(() => fallback));
}

/// An unsafe request; `body` is JSON, or undefined for none.
const send = (method, path, body) => request(path, {
  method, body, headers: body === undefined ? {} : { "Content-Type": "application/json" },
});

let signingIn = null;

/// Asks for the token, once for all waiting requests, until it is right (true) or the user cancels.
function signIn() {
  const field = h("input", { type: "password", required: true, autocomplete: "off" });
  signingIn ??= ask("This service requires a token", [
    h("p", "The token is in the file passed to lacuna-server as --token-file."), h("label", "Token ", field)],
  "Continue", () => send("POST", session, JSON.stringify({ token: field.value }))).finally(() => { signingIn = null; });
  return signingIn;
}

export const jobPath = (id) => `/api/jobs/${encodeURIComponent(id)}`;
const sweepPath = (id) => `/api/sweeps/${encodeURIComponent(id)}`;
/// A query string without empty or zero values.
export const queryOf = (values) => new URLSearchParams(Object.entries(values).filter(([, value]) => value)).toString();

/// The URL of a file of a job. `version` changes with the content, to bypass the browser's cache.
export const fileUrl = (id, name, version) => `${jobPath(id)}/files/${encodeURIComponent(name)}`
  + (version === undefined ? "" : `?v=${encodeURIComponent(version)}`);

const json = async (path, signal) => (await request(path, { signal })).json();
/// [{name, doc, terminal, actions}]: the states of a job, and the actions allowed in each.
export const getStates = async () => (await json("/api/states")).states;
/// A page of the list: {jobs, total, counts, next, last_event}; `wanted`: {state, label, limit, cursor}.
export const getJobs = (wanted, signal) => json(`/api/jobs?${queryOf(wanted)}`, signal);
export const getJob = (id, signal) => json(jobPath(id), signal);
/// {status}, and the obstacle of all jobs: {obstacle}.
export const getHealth = (signal) => json("/health", signal);
export const getScenes = async (signal) => (await json("/api/scenes", signal)).scenes;
/// All sweeps, newest first: [{id, label, state, created, run_count, counts, share}].
export const getSweeps = async (signal) => (await json("/api/sweeps", signal)).sweeps;
/// One sweep with its file, cells and runs.
export const getSweep = (id, signal) => json(sweepPath(id), signal);
/// The answers of its finished runs (docs/sweeps-and-reports.md).
export const getAnswers = (id, signal) => json(`${sweepPath(id)}/answers`, signal);
export const tableUrl = (id) => `${sweepPath(id)}/table.csv`;
/// The present content of a file: a Response.
export const getFile = (id, name, signal) => request(fileUrl(id, name), { signal, cache: "no-cache" });
export const getText = async (id, name, signal) => (await getFile(id, name, signal)).text();

/// Up to `bytes` bytes of a file from `offset` on, none beyond its end: {data, total, tag}, with its length and its
/// ETag, which differs between versions.
export async function getPart(id, name, offset, bytes, signal) {
  const headers = { Range: `bytes=${offset}-${offset + bytes - 1}` };
  const response = await request(fileUrl(id, name), { signal, headers, cache: "no-store" }).catch((error) => {
    if (error.status === 416) return new Response();
    throw error;
  });
  const data = await response.arrayBuffer();
  const total = Number(response.headers.get("Content-Range")?.split("/")[1]);
  return { data, total, tag: response.headers.get("ETag") };
}

/// `verb`: cancel, retry, or extend with the JSON of a body.
export const tell = (id, verb, body) => send("POST", `${jobPath(id)}/${verb}`, body);
/// The brightest paths of a pixel [x, y] in the first `samples` iterations: {samples, seed, bounds, count, paths}.
export const getPaths = async (id, [x, y], samples) =>
  (await send("POST", `${jobPath(id)}/trace?x=${x}&y=${y}&samples=${samples}`)).json();
/// The figure (docs/figures.md) of `spec`, the text of its file, as a blob; `format`: pdf, svg or png.
export const drawFigure = async (spec, format) => (await send("POST", `/api/figures?format=${format}`, spec)).blob();
/// `values`: {priority, held}, either or both.
export const change = (id, values) => send("PATCH", jobPath(id), JSON.stringify(values));
export const remove = (id) => send("DELETE", jobPath(id));
export const cancelSweep = (id) => send("POST", `${sweepPath(id)}/cancel`);
export const removeSweep = (id) => send("DELETE", sweepPath(id));

/// Posts the text of a job file; returns the new job's id.
export async function postJob(text) {
  const response = await send("POST", "/api/jobs", text);
  return decodeURIComponent(response.headers.get("Location").split("/").pop());
}

/// The shell command that posts `body` (an object) to "jobs" or "sweeps" of this server.
export const curlLine = (kind, body) => `curl -sS -X POST ${location.origin}/api/${kind} `
  + `-H 'Content-Type: application/json' \\\n  -d ${shellQuote(JSON.stringify(body))}`;

/// Shows the state of the connection in the header.
const sayLink = (text) => update(document.getElementById("link-state"), text);

/// `soon(ms)` calls `step` once after that time, or earlier if a later call asks for less; calls of `step` do not
/// overlap. Retries unanswered requests; passes other exceptions of `step` to `failed`.
export function soon(step, failed, signal) {
  let due = Infinity;
  let timer;
  let running = Promise.resolve();
  signal.addEventListener("abort", () => {
    clearTimeout(timer);
    sayLink("");
  });
  const again = (error) => {
    if (signal.aborted) return;
    sayLink(error.status === 0 ? noAnswer : "");
    if (error.status === 0) call(retryMs);
    else failed(error);
  };
  function call(ms) {
    const at = performance.now() + ms;
    if (at >= due || signal.aborted) return;
    clearTimeout(timer);
    due = at;
    timer = setTimeout(() => {
      due = Infinity;
      running = running.then(step).then(() => sayLink("")).catch(again);
    }, ms);
  }
  return call;
}

/// Calls `step` after `ms` (a number, or a function that returns one) and again after each of its ends, while the page
/// is visible, until `signal` is aborted, `step` returns false or the user does not enter the token.
export function pollOn(step, ms, signal) {
  const next = () => again(typeof ms === "function" ? ms() : ms);
  const again = soon(async () => {
    if (document.hidden || await step() !== false) next();
  }, (error) => {
    sayLink(error.message);
    if (error.status !== 401) next();
  }, signal);
  next();
}

/// Calls `step` now, rethrowing its errors, and then continues as pollOn() unless it returns false.
export async function poll(step, ms, signal) {
  if (await step() !== false) pollOn(step, ms, signal);
}

/// Listens to events while the page is visible: `on[name](data, id)`. Calls `path()` whenever the stream is opened, and
/// `lost` if no stream is available (many listeners, shutdown, no token). Returns a function that ends it.
export function listen(path, on, lost, signal) {
  let source = null;
  function follow() {
    if (document.hidden) close();
    if (source || document.hidden) return;
    source = new EventSource(path());
    for (const [name, tellIt] of Object.entries(on)) {
      source.addEventListener(name, (event) => tellIt(event.data && JSON.parse(event.data), event.lastEventId));
    }
    source.addEventListener("open", () => sayLink(""));
    source.addEventListener("error", () => {
      if (source?.readyState !== EventSource.CLOSED) return sayLink(noAnswer);
      stop();
      return lost();
    });
  }
  function close() {
    source?.close();
    source = null;
  }
  function stop() {
    document.removeEventListener("visibilitychange", follow);
    close();
    sayLink("");
  }
  if (signal.aborted) return stop;
  document.addEventListener("visibilitychange", follow);
  signal.addEventListener("abort", stop);
  follow();
  return stop;
}
