// Lacuna's HTTP API as the page uses it: requests, problems, polling and events.
import { setText } from "./dom.js";
import { signIn } from "./session.js";

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

async function request(path, options = {}) {
  let response;
  try {
    response = await fetch(path, options);
  } catch (error) {
    if (options.signal?.aborted) throw error;
    throw new ApiError(0, {
      title: "The server does not answer",
      detail: `No answer from ${location.origin}. Is lacuna-server running?`,
    });
  }
  if (response.ok) return response;
  if (response.status === 401 && path !== "/api/session" && await signIn(postToken)) return request(path, options);
  const fallback = { title: `Error ${response.status}`, detail: response.statusText };
  throw new ApiError(response.status, await response.json().catch(() => fallback));
}

/// A request that changes something; `body` is JSON, undefined: there is none.
export const send = (method, path, body) => request(path, {
  method, body, headers: body === undefined ? {} : { "Content-Type": "application/json" },
});
const postToken = (token) => send("POST", "/api/session", JSON.stringify({ token }));

export const jobPath = (id) => `/api/jobs/${encodeURIComponent(id)}`;

/// An address's query without what is empty or 0.
export const queryOf = (values) =>
  new URLSearchParams(Object.entries(values).filter(([, value]) => value)).toString();

/// The address of one file of a job. `version` tells the browser that the content has changed.
export function fileUrl(id, name, version) {
  const path = `${jobPath(id)}/files/${encodeURIComponent(name)}`;
  return version === undefined ? path : `${path}?v=${encodeURIComponent(version)}`;
}

export const json = async (path, signal) => (await request(path, { signal })).json();
/// A part of the list: {jobs, total, counts, next, last_event}; `wanted`: {state, label, limit, cursor}.
export const getJobs = (wanted, signal) => json(`/api/jobs?${queryOf(wanted)}`, signal);
export const getJob = (id, signal) => json(jobPath(id), signal);
/// {status}, and what keeps all jobs from going on: {obstacle}.
export const getHealth = (signal) => json("/health", signal);
export const getScenes = async (signal) => (await json("/api/scenes", signal)).scenes;
/// A file as it is now: a Response.
export const getFile = (id, name, signal) => request(fileUrl(id, name), { signal, cache: "no-cache" });
export const getText = async (id, name, signal) => (await getFile(id, name, signal)).text();

/// Up to `bytes` bytes of a file from `offset` on: {data, total, tag}, with the whole file's length and
/// its ETag, which two versions of it never share. What lies beyond the file's end is empty.
export async function getPart(id, name, offset, bytes, signal) {
  const headers = { Range: `bytes=${offset}-${offset + bytes - 1}` };
  const response = await request(fileUrl(id, name), { signal, headers, cache: "no-store" }).catch((error) => {
    if (error.status === 416) return new Response();
    throw error;
  });
  const data = await response.arrayBuffer();
  const total = /\d+$/.exec(response.headers.get("Content-Range"))?.[0];
  return { data, total: Number(total ?? 0), tag: response.headers.get("ETag") };
}

/// The log from the byte `offset` on: {data, next}, where the rest of it begins; beyond the log's end
/// there is an error 416.
export async function getLog(id, offset, signal) {
  const response = await request(`${jobPath(id)}/log?offset=${offset}`, { signal, cache: "no-store" });
  return { data: await response.arrayBuffer(), next: Number(response.headers.get("Next-Offset")) };
}

/// `verb`: cancel, retry, or extend with the JSON of a body.
export const tell = (id, verb, body) => send("POST", `${jobPath(id)}/${verb}`, body);
/// `values`: {priority, held}, either or both.
export const change = (id, values) => send("PATCH", jobPath(id), JSON.stringify(values));
export const remove = (id) => send("DELETE", jobPath(id));

/// Posts a job file as it was typed; gives the new job's id.
export async function postJob(text) {
  const response = await send("POST", "/api/jobs", text);
  return decodeURIComponent(response.headers.get("Location").split("/").pop());
}

const sayLink = (text) => setText(document.getElementById("link-state"), text);

/// Calls `step` now, and then goes on as pollOn() does unless it gives false. The first call's errors are
/// thrown to the caller.
export async function poll(step, ms, signal) {
  if (await step() !== false) pollOn(step, ms, signal);
}

/// Calls `step` `ms` (a number, or a function that gives one) from now and after each of its ends, while the
/// page can be seen, until `signal` is aborted, `step` gives false or the reader does not show the token. An
/// unanswered request is said in the head of the page and tried again.
export async function pollOn(step, ms, signal) {
  signal.addEventListener("abort", () => sayLink(""));
  for (let more = true; more !== false;) {
    await new Promise((resolve) => { setTimeout(resolve, typeof ms === "function" ? ms() : ms); });
    if (signal.aborted) return;
    if (document.hidden) continue;
    try {
      more = await step();
      sayLink("");
    } catch (error) {
      if (signal.aborted) return;
      sayLink(error.status === 0 ? noAnswer : error.message);
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) return;
    }
  }
}

/// `soon(ms)` calls `step` after that time, however often it is asked until then; who is in a greater
/// hurry goes first. One call ends before the next begins. An unanswered request is said in the head of the
/// page and tried again; what else `step` throws is `failed(error)`'s.
export function soon(step, failed, signal) {
  let due = Infinity;
  let timer;
  let running = Promise.resolve();
  signal.addEventListener("abort", () => clearTimeout(timer));
  const again = (error) => {
    if (signal.aborted) return;
    if (error.status !== 0) {
      failed(error);
      return;
    }
    sayLink(noAnswer);
    ask(retryMs);
  };
  function ask(ms) {
    const at = performance.now() + ms;
    if (at >= due || signal.aborted) return;
    clearTimeout(timer);
    due = at;
    timer = setTimeout(() => {
      due = Infinity;
      running = running.then(step).then(() => sayLink("")).catch(again);
    }, ms);
  }
  return ask;
}

/// Listens to events while the page can be seen: `on[name]` gets the data of the events called so,
/// and their id. `path()` is asked anew whenever the stream is opened. `lost` is called once where
/// events cannot be had (too many listeners, a service that shuts down or asks for the token): pollOn()
/// instead. Gives a function that ends it.
export function listen(path, on, lost, signal) {
  let source = null;
  const close = () => {
    source?.close();
    source = null;
  };
  const open = () => {
    if (source || document.hidden || signal.aborted) return;
    source = new EventSource(path());
    for (const [name, tellIt] of Object.entries(on)) {
      source.addEventListener(name, (event) => tellIt(event.data && JSON.parse(event.data), event.lastEventId));
    }
    source.addEventListener("open", () => sayLink(""));
    source.addEventListener("error", () => {
      if (source?.readyState === EventSource.CLOSED) {
        stop();
        lost();
      } else {
        sayLink(noAnswer);
      }
    });
  };
  const follow = () => (document.hidden ? close() : open());
  document.addEventListener("visibilitychange", follow);
  const stop = () => {
    document.removeEventListener("visibilitychange", follow);
    close();
    sayLink("");
  };
  signal.addEventListener("abort", stop);
  open();
  return stop;
}
