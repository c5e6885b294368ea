// A stand-in for lacuna-server with fixed jobs, which a test changes by hand. By itself
// (`node mock_server.mjs [PORT]`) it serves the page for work on it, with one job that moves on.
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname } from "node:path";
import { fileURLToPath } from "node:url";

import { curve, makeJobs, progress, scenes, schema } from "./fixtures.mjs";

const web = new URL("../../web/", import.meta.url);
const chart = "/usr/share/javascript/chart.js/chart.min.js";
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

/// A file of a job, or the one range of it that is asked for.
function sendFile(request, response, name, content) {
  const bytes = Buffer.from(content);
  const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
  if (!range) return send(response, 200, types[extname(name)], bytes);
  const [first, last] = [Number(range[1]), Math.min(Number(range[2]), bytes.length - 1)];
  return send(response, 206, types[extname(name)], bytes.subarray(first, last + 1),
    { "Content-Range": `bytes ${first}-${last}/${bytes.length}` });
}

const sendJson = (response, value) => send(response, 200, "application/json", JSON.stringify(value));
const problem = (response, status, title, detail, errors = []) => send(response, status,
  "application/problem+json", JSON.stringify({ type: "about:blank", title, status, detail, errors }));

const notFound = (response, what) => problem(response, 404, "Not found", `There is no ${what}.`);

const row = ({ id, job, state, progress: p }) => ({
  id, label: job.label, scene: job.scene, integrator: job.integrator.type, ...state, progress: p,
});

const detail = ({ id, job, state, progress: p, files }) => ({
  id, job, state, progress: p, files: Object.entries(files).map(([name, content]) => ({
    name, bytes: Buffer.byteLength(content), media_type: types[extname(name)],
  })),
});

async function body(request) {
  let text = "";
  for await (const part of request) text += part;
  return text;
}

/// The mock: `jobs` may be changed at will; `update(id, changes)` also sends the events.
export class Mock {
  constructor() {
    this.jobs = makeJobs();
    this.listeners = new Set();
    this.requests = [];
    this.server = createServer((request, response) => this.answer(request, response)
      .catch((error) => problem(response, 500, "Error", error.stack)));
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
    if (changes.state) this.event(id, "state", Object.assign(job.state, changes.state));
    if (changes.progress) this.event(id, "progress", job.progress = changes.progress);
    Object.assign(job.files, changes.files);
  }

  event(id, name, data) {
    for (const listener of this.listeners) {
      if (listener.id === id) listener.response.write(`event: ${name}\ndata: ${JSON.stringify(data)}\n\n`);
    }
  }

  async answer(request, response) {
    const path = decodeURIComponent(new URL(request.url, "http://mock").pathname);
    this.requests.push(`${request.method} ${path}`);
    if (path === "/vendor/chart.js") return send(response, 200, types[".js"], await readFile(chart));
    if (path === "/api/scenes") return sendJson(response, { scenes });
    if (path === "/api/schema/job") return sendJson(response, schema);
    if (path === "/api/jobs" && request.method === "POST") return this.post(request, response);
    if (path === "/api/jobs") return sendJson(response, { jobs: this.jobs.map(row) });
    const match = /^\/api\/jobs\/([^/]+)(?:\/(events|cancel|files)(?:\/([^/]+))?)?$/.exec(path);
    if (match) return this.answerJob(request, response, match);
    const name = path === "/" ? "index.html" : path.slice(1);
    if (!/^[a-z_]+\.(html|css|js)$/.test(name)) return notFound(response, path);
    return send(response, 200, types[extname(name)], await readFile(new URL(name, web)));
  }

  answerJob(request, response, [, id, what, name]) {
    const job = this.find(id);
    if (!job) return notFound(response, `job ${id}`);
    if (what === undefined) return sendJson(response, detail(job));
    if (what === "events") return this.follow(request, response, job);
    if (what === "cancel") {
      this.update(id, { state: { state: "cancelled" } });
      return sendJson(response, detail(job));
    }
    const content = job.files[name];
    return content === undefined ? notFound(response, `file ${name}`) : sendFile(request, response, name, content);
  }

  follow(request, response, job) {
    response.writeHead(200, { "Content-Type": "text/event-stream", "Cache-Control": "no-store" });
    const listener = { id: job.id, response };
    this.listeners.add(listener);
    request.on("close", () => this.listeners.delete(listener));
    this.event(job.id, "state", job.state);
  }

  async post(request, response) {
    const job = JSON.parse(await body(request));
    if (!scenes.includes(job.scene)) {
      return problem(response, 400, "The job is not valid", "1 problem", [
        { pointer: "/scene", message: `found "${job.scene}", allowed: ${scenes.join(", ")}` }]);
    }
    const [like] = makeJobs().slice(1);
    const id = `20260131-120000-new${this.jobs.length}`;
    this.jobs.unshift({ ...like, id, job: { ...like.job, ...job } });
    return send(response, 201, "application/json", JSON.stringify({ id }), { Location: `/api/jobs/${id}` });
  }
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const mock = new Mock();
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
