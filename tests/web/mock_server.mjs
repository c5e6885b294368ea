// A stand-in for lacuna-server with fixed jobs, which a test changes by hand. By itself
// (`node mock_server.mjs [PORT [JOBS]]`) it serves the page for work on it, with one job that moves on.
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname } from "node:path";
import { fileURLToPath } from "node:url";

import { lacuna } from "../server/real_service.mjs";
import { curve, makeJobs, manyJobs, paths, progress, scenes, schema, states } from "./fixtures.mjs";

const web = new URL("../../web/", import.meta.url);
const types = {
  ".html": "text/html; charset=utf-8", ".css": "text/css; charset=utf-8",
  ".js": "text/javascript; charset=utf-8", ".png": "image/png", ".exr": "image/x-exr",
  ".csv": "text/csv; charset=utf-8", ".json": "application/json", ".txt": "text/plain; charset=utf-8",
  ".half": "application/octet-stream",
};
const policy = "default-src 'self'; img-src 'self' blob: data:; object-src 'none'; "
  + "frame-ancestors 'none'; base-uri 'none'";

function send(response, status, type, body, headers = {}) {
  response.writeHead(status, {
    "Content-Type": type, "Content-Security-Policy": policy, "X-Content-Type-Options": "nosniff",
    ...headers,
  });
  response.end(body);
}

const pageFiles = new Map();

/// A file of the page as it was when it was first asked for. One of them is the program's to make.
export function pageFile(name) {
  if (!pageFiles.has(name)) {
    pageFiles.set(name, name === "job_tables.js" ? execFileSync(lacuna, ["schema", "--page"])
      : readFileSync(new URL(name, web)));
  }
  return pageFiles.get(name);
}

const tags = new WeakMap();

function tagOf(bytes) {
  if (!tags.has(bytes)) tags.set(bytes, `"${createHash("sha1").update(bytes).digest("hex")}"`);
  return tags.get(bytes);
}

/// A file of a job, or the one range of it that is asked for.
function sendFile(request, response, name, content) {
  const bytes = Buffer.isBuffer(content) ? content : Buffer.from(content);
  const headers = { ETag: tagOf(bytes), "Cache-Control": "no-cache" };
  const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
  if (!range) return send(response, 200, types[extname(name)], bytes, headers);
  const [first, last] = [Number(range[1]), Math.min(Number(range[2]), bytes.length - 1)];
  if (first > last) return problem(response, 416, "Range not satisfiable", `${bytes.length} bytes`);
  return send(response, 206, types[extname(name)], bytes.subarray(first, last + 1),
    { ...headers, "Content-Range": `bytes ${first}-${last}/${bytes.length}` });
}

const sendJson = (response, value, status = 200) => send(response, status, "application/json", JSON.stringify(value));
const problem = (response, status, title, detail, errors = []) => send(response, status,
  "application/problem+json", JSON.stringify({ type: "about:blank", title, status, detail, errors }));

const notFound = (response, what) => problem(response, 404, "Not found", `There is no ${what}.`);

const row = ({ id, job, state, progress: p, files, priority = 0, held = false }) => ({
  id, label: job.label, scene: job.scene, integrator: job.integrator.type, picture: "image.png" in files,
  ...state, progress: p, priority, held,
});

const detail = ({ id, job, state, progress: p, files, priority = 0, held = false }) => ({
  id, job, state, progress: p, priority, held, files: Object.entries(files).map(([name, content]) => ({
    name, bytes: Buffer.byteLength(content), media_type: types[extname(name)],
  })),
});

async function body(request) {
  let text = "";
  for await (const part of request) text += part;
  return text === "" ? undefined : JSON.parse(text);
}

/// The mock: `jobs` may be changed at will; `update(id, changes)` and `drop(id)` also send the events.
/// With a `token`, it must be known; with `events` false, no event stream is to be had; an `obstacle`
/// keeps all jobs from going on. `drawn` and `traced` are the last requests for a figure and for paths, and `refusal` is
/// the answer to both, if it is not empty.
export class Mock {
  constructor() {
    this.reset();
    this.server = createServer((request, response) => this.answer(request, response)
      .catch((error) => problem(response, 500, "Error", error.stack)));
  }

  /// As at first; who listened is sent away.
  reset() {
    for (const { response } of this.listeners ?? []) response.destroy();
    this.jobs = makeJobs();
    this.listeners = new Set();
    this.requests = [];
    this.token = null;
    this.events = true;
    this.obstacle = "";
    this.refusal = "";
    this.drawn = this.traced = null;
    this.states = states;
    this.told = 0;
  }

  async listen(port = 0) {
    await new Promise((resolve) => { this.server.listen(port, "127.0.0.1", resolve); });
    return `http://127.0.0.1:${this.server.address().port}`;
  }

  close() {
    this.server.closeAllConnections();
    this.server.close();
  }

  find = (id) => this.jobs.find((job) => job.id === id);

  update(id, changes) {
    const job = this.find(id);
    const { state, progress: p, files, ...rest } = changes;
    Object.assign(job, rest);
    Object.assign(job.files, files);
    if (state) this.event(id, "state", Object.assign(job.state, state));
    if (p) this.event(id, "progress", job.progress = p);
    if (state || p || "priority" in rest) this.event(null, "job", row(job));
  }

  add(job) {
    this.jobs.unshift(job);
    this.event(null, "job", row(job));
  }

  drop(id) {
    this.jobs = this.jobs.filter((job) => job.id !== id);
    this.event(null, "removed", { id });
  }

  /// To those that listen to the job `id`; null: to those that listen to all.
  event(id, name, data) {
    if (id === null) this.told += 1;
    for (const listener of this.listeners) {
      if (listener.id === id) {
        listener.response.write(`id: mock-${this.told}\nevent: ${name}\ndata: ${JSON.stringify(data)}\n\n`);
      }
    }
  }

  async answer(request, response) {
    const url = new URL(request.url, "http://mock");
    const path = decodeURIComponent(url.pathname);
    this.requests.push(`${request.method} ${path}`);
    if (path === "/api/session") {
      if ((await body(request)).token !== this.token) return problem(response, 401, "Unauthorized", "That is not the token.");
      return send(response, 204, "text/plain", "", { "Set-Cookie": `lacuna=${this.token}; HttpOnly; SameSite=Strict` });
    }
    if (path === "/health") {
      return sendJson(response, this.obstacle ? { status: "waiting", obstacle: this.obstacle } : { status: "ok" });
    }
    if (path.startsWith("/api/")) {
      if (this.token !== null && request.headers.cookie !== `lacuna=${this.token}`) {
        return problem(response, 401, "Unauthorized", "A token is needed.");
      }
      return this.answerApi(request, response, url, path);
    }
    const name = path === "/" ? "index.html" : path.slice(1);
    if (!/^[a-z_]+\.(html|css|js)$/.test(name)) return notFound(response, path);
    return send(response, 200, types[extname(name)], pageFile(name), { "Cache-Control": "max-age=600" });
  }

  async answerApi(request, response, url, path) {
    if (path === "/api/states") return sendJson(response, { states: this.states });
    if (path === "/api/scenes") return sendJson(response, { scenes });
    if (path === "/api/schema/job") return sendJson(response, schema);
    if (path === "/api/jobs" && request.method === "POST") return this.post(request, response);
    if (path === "/api/jobs") return this.list(response, url.searchParams);
    if (path === "/api/figures") {
      this.drawn = { spec: await body(request), format: url.searchParams.get("format") };
      if (this.refusal) return problem(response, 400, "Bad request", this.refusal);
      return send(response, 200, "application/pdf", "%PDF");
    }
    if (path === "/api/events") return this.follow(request, response, null);
    const match = /^\/api\/jobs\/([^/]+)(?:\/(events|log|cancel|retry|extend|files|trace)(?:\/([^/]+))?)?$/.exec(path);
    if (!match) return notFound(response, path);
    const [, id, what, name] = match;
    const job = this.find(id);
    if (!job) return notFound(response, `job ${id}`);
    if (what === "trace") {
      const [x, y, samples] = ["x", "y", "samples"].map((key) => Number(url.searchParams.get(key)));
      this.traced = { id, pixel: [x, y], samples };
      if (this.refusal) return problem(response, 400, "Bad request", this.refusal);
      return sendJson(response, { ...paths, pixel: [x, y], samples });
    }
    if (request.method !== "GET") return this.change(request, response, job, what ?? request.method);
    if (what === undefined) return sendJson(response, detail(job));
    if (what === "events") return this.follow(request, response, job);
    const content = job.files[name ?? "log.txt"];
    if (content === undefined) return notFound(response, `file ${name}`);
    return what === "log" ? this.log(response, Buffer.from(content), Number(url.searchParams.get("offset")))
      : sendFile(request, response, name, content);
  }

  /// A cursor is the id of the last job of the page before.
  list(response, query) {
    const [states, label] = [(query.get("state") ?? "").split(",").filter(Boolean), (query.get("label") ?? "").toLowerCase()];
    const counts = {};
    for (const { state } of this.jobs) counts[state.state] = (counts[state.state] ?? 0) + 1;
    const found = this.jobs.filter(({ id, job, state }) => (states.length === 0 || states.includes(state.state))
      && [id, job.label, job.scene, job.integrator.type].some((text) => text.toLowerCase().includes(label)));
    const first = query.has("cursor") ? 1 + found.findIndex(({ id }) => id === query.get("cursor")) : 0;
    const jobs = found.slice(first, first + Number(query.get("limit") ?? 100));
    return sendJson(response, { jobs: jobs.map(row), total: found.length, counts, last_event: `mock-${this.told}`,
      next: first + jobs.length < found.length ? jobs.at(-1).id : null });
  }

  log(response, bytes, offset) {
    if (offset > bytes.length) return problem(response, 416, "Range not satisfiable", `${bytes.length} bytes`);
    const part = bytes.subarray(offset, offset + 2 ** 20);
    return send(response, 200, types[".txt"], part, { "Next-Offset": offset + part.length });
  }

  /// What is allowed here is what the service allows; `job.state` says what comes of it at once.
  async change(request, response, job, what) {
    const given = await body(request);
    const { state } = job.state;
    const { actions } = this.states.find(({ name }) => name === state);
    const action = { PATCH: "priority", DELETE: "delete" }[what] ?? what;
    if (!actions.includes(action)) return problem(response, 409, "Conflict", `The job is ${state}.`);
    if (what === "DELETE") {
      this.drop(job.id);
      return send(response, 204, "text/plain", "");
    }
    if (what === "extend" && given.budget.seconds < job.job.budget.seconds) {
      return problem(response, 400, "The budget is too small", `/budget/seconds: found ${given.budget.seconds}, `
        + `allowed: ${job.job.budget.seconds} or more`);
    }
    if (what === "extend") job.job = { ...job.job, budget: { ...job.job.budget, ...given.budget } };
    if (what === "PATCH") {
      const held = given.held ?? job.held;
      this.update(job.id, { ...given, ...(given.held === undefined ? {} : { state: { state: held ? "held" : "queued", phase: "" } }) });
    } else {
      this.update(job.id, { state: { state: what === "cancel" ? "cancelled" : "queued", error: "" } });
    }
    return sendJson(response, detail(job));
  }

  follow(request, response, job) {
    if (!this.events) return problem(response, 503, "Service unavailable", "Too many listeners.");
    response.writeHead(200, { "Content-Type": "text/event-stream", "Cache-Control": "no-store" });
    response.write(": here\n\n");
    const listener = { id: job?.id ?? null, response };
    this.listeners.add(listener);
    request.on("close", () => this.listeners.delete(listener));
    if (job) this.event(job.id, "state", job.state);
  }

  async post(request, response) {
    const job = await body(request);
    if (!scenes.includes(job.scene)) {
      return problem(response, 400, "The job is not valid", "1 problem", [
        { pointer: "/scene", message: `found "${job.scene}", allowed: ${scenes.join(", ")}` }]);
    }
    const [like] = makeJobs().slice(1);
    const id = `20260131-120000-new${this.jobs.length}`;
    this.add({ ...like, id, job: { ...like.job, ...job } });
    return send(response, 201, "application/json", JSON.stringify({ id }), { Location: `/api/jobs/${id}` });
  }
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const mock = new Mock();
  mock.jobs.push(...manyJobs(Number(process.argv[3] ?? 0)));
  console.log(await mock.listen(Number(process.argv[2] ?? 0)));
  let step = 4;
  setInterval(() => {
    step = step < 39 ? step + 1 : 4;
    mock.update("20260131-101900-running", {
      progress: progress(step, step / 40, { error_metric: "est_rmse" }),
      files: { "curve.csv": curve({ rows: 1 + Math.floor(Math.log2(step)), cost: 0.7, level: 0.4 }) },
    });
  }, 1000);
}
