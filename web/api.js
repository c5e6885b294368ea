// Lacuna's HTTP API as the page uses it: requests, problems, polling and events.
import { ask, h, update } from "./dom.js";
import { shellQuote } from "./format.js";

/// A request that did not succeed: problem+json, or `status` 0 where no answer came.
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

/// A request that changes something; `body` is JSON, undefined: there is none.
const send = (method, path, body) => request(path, {
  method, body, headers: body === undefined ? {} : { "Content-Type": "application/json" },
});

let signingIn = null;

/// Asks for the token, once for all that wait for it, until it is right (true) or the reader gives up.
function signIn() {
  const field = h("input", { type: "password", required: true, autocomplete: "off" });
  signingIn ??= ask("This service requires a token", [
    h("p", "The token is in the file passed to lacuna-server as --token-file."), h("label", "Token ", field)],
  "Go on", () => send("POST", session, JSON.stringify({ token: field.value }))).finally(() => { signingIn = null; });
  return signingIn;
}

export const jobPath = (id) => `/api/jobs/${encodeURIComponent(id)}`;
const sweepPath = (id) => `/api/sweeps/${encodeURIComponent(id)}`;
/// An address's query without what is empty or 0.
export const queryOf = (values) => new URLSearchParams(Object.entries(values).filter(([, value]) => value)).toString();

/// The address of one file of a job. `version` tells the browser that the content has changed.
export const fileUrl = (id, name, version) => `${jobPath(id)}/files/${encodeURIComponent(name)}`
  + (version === undefined ? "" : `?v=${encodeURIComponent(version)}`);

const json = async (path, signal) => (await request(path, { signal })).json();
/// [{name, doc, terminal, actions}]: what a job can be, and what may be asked of it then.
export const getStates = async () => (await json("/api/states")).states;
/// A part of the list: {jobs, total, counts, next, last_event}; `wanted`: {state, label, limit, cursor}.
export const getJobs = (wanted, signal) => json(`/api/jobs?${queryOf(wanted)}`, signal);
export const getJob = (id, signal) => json(jobPath(id), signal);
/// {status}, and what keeps all jobs from going on: {obstacle}.
export const getHealth = (signal) => json("/health", signal);
export const getScenes = async (signal) => (await json("/api/scenes", signal)).scenes;
/// All sweeps, newest first: [{id, label, state, created, run_count, counts, share}].
export const getSweeps = async (signal) => (await json("/api/sweeps", signal)).sweeps;
/// One with its file, cells and runs.
export const getSweep = (id, signal) => json(sweepPath(id), signal);
/// What its finished runs say (docs/sweeps-and-reports.md).
export const getAnswers = (id, signal) => json(`${sweepPath(id)}/answers`, signal);
export const tableUrl = (id) => `${sweepPath(id)}/table.csv`;
/// A file as it is now: a Response.
export const getFile = (id, name, signal) => request(fileUrl(id, name), { signal, cache: "no-cache" });
export const getText = async (id, name, signal) => (await getFile(id, name, signal)).text();

/// Up to `bytes` bytes of a file from `offset` on, none beyond its end: {data, total, tag}, with its length and its
/// ETag, which two versions of it never share.
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
/// `values`: {priority, held}, either or both.
export const change = (id, values) => send("PATCH", jobPath(id), JSON.stringify(values));
export const remove = (id) => send("DELETE", jobPath(id));
export const cancelSweep = (id) => send("POST", `${sweepPath(id)}/cancel`);
export const removeSweep = (id) => send("DELETE", sweepPath(id));

/// Posts a job file as it was typed; gives the new job's id.
export async function postJob(text) {
  const response = await send("POST", "/api/jobs", text);
  return decodeURIComponent(response.headers.get("Location").split("/").pop());
}

/// The command that posts `body` (an object) to "jobs" or "sweeps" of this server.
export const curlLine = (kind, body) => `curl -sS -X POST ${location.origin}/api/${kind} `
  + `-H 'Content-Type: application/json' \\\n  -d ${shellQuote(JSON.stringify(body))}`;

/// Says in the head of the page how the service answers.
const sayLink = (text) => update(document.getElementById("link-state"), text);

/// `soon(ms)` calls `step` after that time, however often it is asked until then; who is in a greater hurry goes first,
/// one call ends before the next begins. An unanswered request is tried again; `failed` gets what else `step` throws.
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

/// Calls `step` `ms` (a number, or a function that gives one) from now and after each of its ends, while the page is
/// seen, until `signal` is aborted, `step` gives false or the reader does not show the token.
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

/// Calls `step` now, whose errors are thrown to the caller, and then goes on as pollOn() does unless it gives false.
export async function poll(step, ms, signal) {
  if (await step() !== false) pollOn(step, ms, signal);
}

/// Listens to events while the page can be seen: `on[name](data, id)`. `path()` is asked whenever the stream is opened,
/// `lost` called where no events can be had (many listeners, shutdown, no token). Gives a function that ends it.
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
