// Starts the real lacuna-server for a test, on a free port and in folders of its own.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import fs from "node:fs";
import net from "node:net";
import os from "node:os";
import path from "node:path";
import { setImmediate } from "node:timers/promises";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const bin = process.env.LACUNA_BIN ?? path.join(here, "../../build/release/bin");
export const binary = path.join(bin, "lacuna-server");
export const fakeRenderer = path.join(here, "fake_renderer.mjs");
export const web = path.join(here, "../../web");

/// Calls `check` until it gives something truthy, and gives that. The limit finds what hangs: renderers
/// stand back (niceness 10), and wait long for a busy machine.
export async function until(check, what, ms = 180000) {
  const end = Date.now() + ms;
  for (;;) {
    const value = await check();
    if (value) return value;
    assert.ok(Date.now() < end, `in ${ms} ms it did not happen: ${what}`);
    await new Promise((resolve) => { setTimeout(resolve, 10); });
  }
}

/// Runs the program to its end: {code, out, err}.
export async function runToEnd(args, options = {}) {
  const child = spawn(binary, args, { stdio: ["ignore", "pipe", "pipe"], ...options });
  const seen = { out: "", err: "" };
  child.stdout.on("data", (d) => { seen.out += d; });
  child.stderr.on("data", (d) => { seen.err += d; });
  const code = await new Promise((resolve) => { child.on("close", resolve); });
  return { code, ...seen };
}

/// Fresh folders: {root, data, scenes}. After the test the services in them are killed and they are
/// removed.
export function folders(t) {
  const root = fs.mkdtempSync(path.join(os.tmpdir(), "lacuna-test-"));
  const services = [];
  t.after(async () => {
    await Promise.all(services.map((service) => service.stop("SIGKILL")));
    await until(() => !rendererIn(root), "the last renderer has ended");
    fs.rmSync(root, { recursive: true, force: true });
  });
  const scenes = path.join(root, "scenes");
  fs.mkdirSync(path.join(scenes, "room"), { recursive: true });
  fs.writeFileSync(path.join(scenes, "room/scene.glb"), "no renderer looks at it");
  return { root, data: path.join(root, "data"), scenes, services };
}

/// Whether a process works in a folder below `root`.
function rendererIn(root) {
  return fs.readdirSync("/proc").some((pid) => {
    try {
      return /^\d+$/.test(pid) && fs.readlinkSync(`/proc/${pid}/cwd`).startsWith(root);
    } catch {
      return false;  // it has ended meanwhile
    }
  });
}

/// A sweep file for the fake renderer.
export const sweepFile = (label, more = {}) =>
  ({ label, job: { scene: "room/scene.glb" }, ...more });

/// A running service.
export class Service {
  /// `wrapper`: a program and its arguments that the service is started by.
  static async start(places, args = [], wrapper = []) {
    const service = new Service();
    service.places = places;
    const [program, ...before] = [...wrapper, binary];
    service.child = spawn(program, [...before,
      "--port", "0", "--data", places.data, "--scenes", places.scenes, "--web", web,
      "--renderer", fakeRenderer, ...args,
    ], { stdio: ["ignore", "pipe", "pipe"] });
    let out = "";
    service.log = "";
    service.child.stdout.on("data", (d) => { out += d; });
    service.child.stderr.on("data", (d) => { service.log += d; });
    service.ended = new Promise((resolve) => {
      service.child.on("close", (code, signal) => resolve({ code, signal }));
    });
    let over = false;
    service.ended.then(() => { over = true; });
    places.services.push(service);
    await until(() => over || out.includes("\n"), "the service says its address");
    const address = /^lacuna-server: listening on http:\/\/[\d.]+:(\d+)\/\n$/.exec(out);
    assert.ok(address, `it said ${JSON.stringify(out)} and ${service.log}`);
    service.port = Number(address[1]);
    service.url = `http://127.0.0.1:${service.port}/`;
    return service;
  }

  stop(signal = "SIGTERM") {
    if (this.child.exitCode === null) this.child.kill(signal);
    return this.ended;
  }

  /// Where the test has computed for long, it hears first which idle connections were closed: in the second turn
  /// of the loop, since this one has polled already.
  async fetch(target, options) {
    await setImmediate();
    await setImmediate();
    return fetch(new URL(target, this.url), options);
  }

  async json(target, status = 200) {
    const response = await this.fetch(target);
    assert.equal(response.status, status, target);
    return response.json();
  }

  postText(body, headers = { "Content-Type": "application/json" }) {
    return this.fetch("/api/jobs", { method: "POST", headers, body });
  }

  /// Posts a job for the fake renderer; gives its id.
  async post(label, more = {}) {
    const response = await this.postText(JSON.stringify({ scene: "room/scene.glb", label, ...more }));
    const job = await response.json();
    assert.equal(response.status, 201, JSON.stringify(job));
    return job.id;
  }

  postSweepText(body, headers = {}, query = "") {
    return this.fetch(`/api/sweeps${query}`, {
      method: "POST", headers: { "Content-Type": "application/json", ...headers }, body });
  }

  /// Posts a sweep for the fake renderer; gives its JSON.
  async postSweep(label, more = {}) {
    const response = await this.postSweepText(JSON.stringify(sweepFile(label, more)));
    const sweep = await response.json();
    assert.equal(response.status, 201, JSON.stringify(sweep));
    return sweep;
  }

  sweep(id) {
    return this.json(`/api/sweeps/${id}`);
  }

  cancelSweep(id) {
    return this.fetch(`/api/sweeps/${id}/cancel`, { method: "POST" });
  }

  /// Waits until a sweep is in a state; gives its JSON.
  sweepReaches(id, state, ms) {
    return until(async () => {
      const sweep = await this.sweep(id);
      return sweep.state === state && sweep;
    }, `sweep ${id} is ${state}`, ms);
  }

  /// Waits until the `index`-th run of a sweep, in its order, is in a state; gives its job's id.
  runReaches(id, index, state) {
    return until(async () => {
      const run = (await this.sweep(id)).runs[index];
      return run.state === state && run.job;
    }, `run ${index} of sweep ${id} is ${state}`);
  }

  sweepFolder(id) {
    return path.join(this.places.data, "sweeps", id);
  }

  cancel(id) {
    return this.fetch(`/api/jobs/${id}/cancel`, { method: "POST" });
  }

  /// Waits up to `ms` until a job is in a state; gives its JSON. `running`: until its renderer has
  /// said so itself, and hears signals.
  reaches(id, state, ms) {
    return until(async () => {
      const job = await this.json(`/api/jobs/${id}`);
      const heard = state !== "running" || job.state.phase !== "";
      return job.state.state === state && heard && job;
    }, `job ${id} is ${state}`, ms);
  }

  /// The row of a job or sweep in the database of a service that has ended.
  stored(id, table = "jobs") {
    const script = "import sqlite3, sys, json\ndb = sqlite3.connect(sys.argv[1])\ndb.row_factory = sqlite3.Row\n"
      + "print(json.dumps(dict(db.execute(f'SELECT * FROM {sys.argv[2]} WHERE id=?', (sys.argv[3],)).fetchone())))";
    return JSON.parse(execFileSync("python3",
      ["-c", script, path.join(this.places.data, "lacuna.db"), table, id], { encoding: "utf8" }));
  }

  folder(id) {
    return path.join(this.places.data, "jobs", id);
  }

  /// Lets the fake renderer's jobs with label "gate NAME" end.
  open(name) {
    fs.writeFileSync(path.join(this.places.data, name), "");
  }

  /// Sends bytes as they are; gives {status, head, body} of the answer, once it is whole (by its
  /// Content-Length) or the service has closed.
  async raw(text) {
    const socket = net.connect(this.port, "127.0.0.1");
    const chunks = [];
    socket.on("data", (d) => {
      chunks.push(d);
      const all = Buffer.concat(chunks).toString("latin1");
      const end = all.indexOf("\r\n\r\n") + 4;
      const length = /^Content-Length: (\d+)\r$/m.exec(all.slice(0, end - 2));
      if (end >= 4 && length && all.length >= end + Number(length[1])) socket.destroy();
    });
    socket.on("error", () => {});
    const closed = new Promise((resolve) => { socket.on("close", resolve); });
    socket.write(text);
    await closed;
    const [head, ...body] = Buffer.concat(chunks).toString("latin1").split("\r\n\r\n");
    return { status: Number(head.split(" ")[1]), head, body: body.join("\r\n\r\n") };
  }
}

/// A request head for Service.raw, after whose answer the service closes.
export const head = (line, headers = {}) => {
  const all = { Host: "localhost", Connection: "close", ...headers };
  return `${line} HTTP/1.1\r\n${Object.entries(all).map(([k, v]) => `${k}: ${v}\r\n`).join("")}\r\n`;
};
