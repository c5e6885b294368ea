// Lacuna's HTTP API as the page uses it: requests, problems, polling and events.

/// A request that did not succeed: problem+json, or `status` 0 where no answer came.
export class ApiError extends Error {
  constructor(status, problem) {
    super(problem.detail || problem.title);
    this.status = status;
    this.title = problem.title;
    this.errors = problem.errors ?? [];
  }
}

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
  const fallback = { title: `Error ${response.status}`, detail: response.statusText };
  throw new ApiError(response.status, await response.json().catch(() => fallback));
}

const jobPath = (id) => `/api/jobs/${encodeURIComponent(id)}`;

/// The address of one file of a job. `version` tells the browser that the content has changed.
export function fileUrl(id, name, version) {
  const path = `${jobPath(id)}/files/${encodeURIComponent(name)}`;
  return version === undefined ? path : `${path}?v=${encodeURIComponent(version)}`;
}

const json = async (path, signal) => (await request(path, { signal })).json();
export const getJobs = async (signal) => (await json("/api/jobs", signal)).jobs;
export const getJob = (id, signal) => json(jobPath(id), signal);
export const getScenes = async (signal) => (await json("/api/scenes", signal)).scenes;
export const getJobSchema = (signal) => json("/api/schema/job", signal);
export const getText = async (id, name, signal) =>
  (await request(fileUrl(id, name), { signal, cache: "no-cache" })).text();
export const getJson = async (id, name, signal) =>
  (await request(fileUrl(id, name), { signal, cache: "no-cache" })).json();

/// `bytes` bytes of a file from `offset` on, as an ArrayBuffer.
export async function getPart(id, name, offset, bytes, signal) {
  if (bytes === 0) return new ArrayBuffer(0);
  const headers = { Range: `bytes=${offset}-${offset + bytes - 1}` };
  const response = await request(fileUrl(id, name), { signal, headers, cache: "no-store" });
  const data = await response.arrayBuffer();
  const part = response.status === 206 ? data : data.slice(offset, offset + bytes);
  if (part.byteLength === bytes) return part;
  throw new ApiError(response.status, {
    title: "A part of a file is missing",
    detail: `${name} has ${part.byteLength} of the ${bytes} bytes from ${offset} on.`,
  });
}

export const cancelJob = (id) => request(`${jobPath(id)}/cancel`, { method: "POST" });

/// Posts a job file as it was typed; gives the new job's id.
export async function postJob(text) {
  const response = await request("/api/jobs", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: text,
  });
  return decodeURIComponent(response.headers.get("Location").split("/").pop());
}

/// done, failed, cancelled: nothing will happen any more.
export const isTerminal = (state) => ["done", "failed", "cancelled"].includes(state);
export const canCancel = (state) => ["queued", "running", "interrupted"].includes(state);

function whenVisible(signal) {
  if (!document.hidden) return Promise.resolve();
  return new Promise((resolve) => {
    document.addEventListener("visibilitychange", resolve, { once: true, signal });
  });
}

function sayLink(text) {
  const place = document.getElementById("link-state");
  if (place.textContent !== text) place.textContent = text;
}

const longestPause = 30_000;

/// Calls `step` now and `ms` after its end (later after a long one, so that thousands of jobs do not
/// keep both sides busy), while the page can be seen, until `signal` is aborted or `step` gives
/// false. An unanswered request is said in the head of the page and tried again; other errors end
/// it. The first call's errors are thrown to the caller.
export async function poll(step, ms, signal) {
  signal.addEventListener("abort", () => sayLink(""));
  let began = performance.now();
  let more = await step();
  (async () => {
    while (more !== false) {
      const pause = Math.max(ms, Math.min(longestPause, 10 * (performance.now() - began)));
      await new Promise((resolve) => { setTimeout(resolve, pause); });
      await whenVisible(signal);
      if (signal.aborted) return;
      began = performance.now();
      try {
        more = await step();
        sayLink("");
      } catch (error) {
        if (signal.aborted) return;
        sayLink(error instanceof ApiError && error.status === 0
          ? "The server does not answer; trying again." : error.message);
        if (!(error instanceof ApiError)) throw error;
      }
    }
  })();
}

/// Listens to a job's events while the page can be seen: `on.state` and `on.progress` get the data.
/// `on.lost` is called once where events cannot be had (too many listeners): poll instead.
export function listen(id, on, signal) {
  let source = null;
  const close = () => {
    source?.close();
    source = null;
  };
  const open = () => {
    if (source || document.hidden || signal.aborted) return;
    source = new EventSource(`${jobPath(id)}/events`);
    for (const name of ["state", "progress"]) {
      source.addEventListener(name, (event) => on[name](JSON.parse(event.data)));
    }
    source.addEventListener("open", () => sayLink(""));
    source.addEventListener("error", () => {
      if (source?.readyState === EventSource.CLOSED) {
        close();
        document.removeEventListener("visibilitychange", follow);
        on.lost();
      } else {
        sayLink("The server does not answer; trying again.");
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
