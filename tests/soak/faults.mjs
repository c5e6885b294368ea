// Faults of the machine, one after another, while jobs and a sweep are rendered: descriptors, inodes, a full disk, a
// disk that turns read-only, a file-size limit, idle half-requests, a clock that jumps, a second service, each n-th call
// of write, fsync, rename, open and mkdir (ENOSPC, EIO, EMFILE, EROFS), kills. No job
// that was accepted is lost or fails, and every picture has the bits of one that nobody disturbed. Faults that this
// machine does not allow to be made are left out, by name. Mounts need root; they are made in a mount namespace of this
// script's own, which it enters by calling itself.
// LACUNA_BIN: the programs; LACUNA_ROUNDS: how often all faults come (1).
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import fs from "node:fs";
import net from "node:net";
import os from "node:os";
import path from "node:path";
import { setTimeout as pause } from "node:timers/promises";
import { fileURLToPath } from "node:url";

const self = fileURLToPath(import.meta.url);
if (!process.argv.includes("--inside")) {
  const inside = [process.execPath, self, "--inside"];
  const can = spawnSync("unshare", ["-m", "true"]).status === 0;
  if (!can) console.log("no mount namespace of its own is allowed: faults of disks are left out");
  const [program, ...args] = can ? ["unshare", "-m", ...inside] : inside;
  process.exit(spawnSync(program, args, { stdio: "inherit", env: { ...process.env, LACUNA_MOUNTS: can ? "1" : "" } }).status ?? 1);
}

const root = path.join(path.dirname(self), "../..");
const bin = process.env.LACUNA_BIN ?? path.join(root, "build/release/bin");
const lacuna = path.join(bin, "lacuna");
const scenes = path.join(root, "jobs/scenes");
const places = fs.mkdtempSync(path.join(os.tmpdir(), "lacuna-faults-"));
const data = path.join(places, "data");
const disk = path.join(data, "jobs");
const rounds = Number(process.env.LACUNA_ROUNDS ?? 1);
const patience = 300000;
const ends = ["done", "failed", "cancelled"];
const run = (program, ...args) => spawnSync(program, args, { encoding: "utf8" });
const leftOut = new Map();

async function until(check, what) {
  for (const end = Date.now() + patience; ;) {
    const value = await check();
    if (value) return value;
    assert.ok(Date.now() < end, `it did not happen: ${what}`);
    await pause(50);
  }
}

/// A running service: {child, url, log(), ended}.
async function start(wrapper = [], environment = {}) {
  const [program, ...before] = [...wrapper, path.join(bin, "lacuna-server")];
  const child = spawn(program, [...before, "--port", "0", "--data", data, "--scenes", scenes, "--renderer", lacuna, "--web",
    path.join(root, "web"), "--jobs", "2", "--grace", "2", "--nice", "0", "--max-attempts", "3", "--disk-floor", "4M"],
  { stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, ...environment } });
  let out = "";
  let log = "";
  child.stdout.on("data", (d) => { out += d; });
  child.stderr.on("data", (d) => { log += d; });
  let over = false;
  const ended = new Promise((resolve) => { child.on("close", (code) => { over = true; resolve(code); }); });
  await until(() => over || out.includes("\n"), "the service says its address");
  assert.ok(!over, log);
  return { child, ended, log: () => log, url: /http:\S+/.exec(out)[0] };
}

async function ask(service, target, request = {}) {
  try {
    const response = await fetch(new URL(target, service.url), { ...request, signal: AbortSignal.timeout(20000) });
    return { status: response.status, body: await response.json() };
  } catch {
    return { status: 0 };
  }
}

const spec = (kind) => ({ scene: "cornell.glb", resolution: [96, 96], seed: 1 + kind, threads: 1,
  budget: { iterations: 30 + 20 * kind }, checkpoint_seconds: 0.1 });
const kinds = 3;
const wishes = [];  // {key, kind, id}
const sweep = { id: null, runs: 2 * kinds };

const postJson = (service, target, key, body) => ask(service, target, { method: "POST", body: JSON.stringify(body),
  headers: { "Content-Type": "application/json", "Idempotency-Key": key } });

/// Posts what has no answer yet; what is refused meanwhile is no accepted job.
async function post(service) {
  for (const wish of wishes.filter((w) => !w.id)) {
    const answer = await postJson(service, "/api/jobs", wish.key, { ...spec(wish.kind), label: wish.key });
    assert.ok([0, 200, 201, 503, 507].includes(answer.status), JSON.stringify(answer));
    if (answer.status === 200 || answer.status === 201) wish.id = answer.body.id;
  }
  if (sweep.id) return;
  const each = Array.from({ length: kinds }, (_, kind) => spec(kind));
  const answer = await postJson(service, "/api/sweeps", "sweep", { job: { ...spec(0) }, alone: false,
    zip: [{ "/seed": each.map((s) => s.seed), "/budget": each.map((s) => s.budget) }], axes: { "/threads": [1, 2] } });
  assert.ok([0, 200, 201, 503, 507].includes(answer.status), JSON.stringify(answer));
  if (answer.status === 200 || answer.status === 201) sweep.id = answer.body.id;
}

const descriptors = (service, n) => run("prlimit", "--pid", service.child.pid, `--nofile=${n}:`).status === 0;

/// Fills the disk with empty files, or with one large one; gives what takes them away.
function fill(what) {
  const ballast = path.join(disk, ".ballast");
  fs.mkdirSync(ballast, { recursive: true });
  try {
    if (what === "bytes") run("dd", "if=/dev/zero", `of=${ballast}/large`, "bs=4096");
    for (let i = 0; what === "inodes"; i += 1) fs.writeFileSync(path.join(ballast, String(i)), "");
  } catch {
    // it is full
  }
  return () => fs.rmSync(ballast, { recursive: true, force: true });
}

/// What is done to the service; each gives the service that goes on, or a word why it is left out.
const faults = {
  async descriptors(service) {
    if (!descriptors(service, 3)) return "prlimit is not there";
    await pause(3000);
    descriptors(service, 1024);
    return service;
  },
  async inodes(service) {
    if (!mounted) return "no disk of its own";
    const free = fill("inodes");
    await pause(4000);
    free();
    return service;
  },
  async "full disk"(service) {
    if (!mounted) return "no disk of its own";
    const free = fill("bytes");
    await pause(4000);
    free();
    return service;
  },
  async "read-only disk"(service) {
    if (!mounted) return "no disk of its own";
    // Files that are open for writing keep a disk from turning read-only: so a second mount of it is laid over the first.
    if (run("mount", "--bind", disk, disk).status !== 0) return "it cannot be mounted again";
    assert.equal(run("mount", "-o", "remount,ro,bind", disk).status, 0);
    await pause(4000);
    assert.equal(run("umount", "-l", disk).status, 0);
    return service;
  },
  async "file-size limit"(service) {
    for (const pid of [service.child.pid]) run("prlimit", "--pid", pid, "--fsize=2000:");
    await pause(4000);
    run("prlimit", "--pid", service.child.pid, "--fsize=unlimited:");
    return service;
  },
  async "half requests"(service) {
    const { port } = new URL(service.url);
    const sockets = Array.from({ length: 2000 }, () => {
      const socket = net.connect(Number(port), "127.0.0.1");
      socket.on("error", () => {});
      socket.write("GET /health HTTP/1.1\r\n");
      return socket;
    });
    await pause(3000);
    sockets.forEach((socket) => socket.destroy());
    return service;
  },
  async "clock jumps"(service) {
    const library = ["/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1"].find((file) => fs.existsSync(file));
    if (!library) return "libfaketime is not there (Debian package libfaketime)";
    let now = service;
    for (const jump of ["-400d", "+400d"]) {
      now.child.kill("SIGTERM");
      await now.ended;
      now = await start([], { LD_PRELOAD: library, FAKETIME: jump, DONT_FAKE_MONOTONIC: "1" });
      await pause(2000);
    }
    now.child.kill("SIGTERM");
    await now.ended;
    return start();
  },
  async "second service"(service) {
    await assert.rejects(start(), /another lacuna-server is using/);
    return service;
  },
  async "each n-th call"(service) {
    service.child.kill("SIGTERM");
    await service.ended;
    const active = path.join(places, "failing");
    const now = await start([], { LD_PRELOAD: path.join(bin, "../tests/failing_calls.so"), LACUNA_FAIL_UNDER: data,
      LACUNA_FAIL_WHILE: active });
    // What is refused is not done: the list has what was accepted, and runs of the sweep.
    const unaccepted = async () => {
      const { body } = await until(async () => {
        const answer = await ask(now, "/api/jobs?limit=1000");
        return answer.status === 200 && answer;
      }, "the jobs are listed");
      const known = new Set(wishes.map((w) => w.id));
      return body.jobs.filter((job) => !job.sweep && !known.has(job.id)).map((job) => job.label);
    };
    for (const period of [50, 20, 10, 7, 5, 3, 2, 1]) {
      for (let i = 0; i < 2; i += 1) wishes.push({ key: `call-${period}-${i}-${wishes.length}`, kind: i % kinds });
      fs.writeFileSync(active, String(period));
      for (const end = Date.now() + 3000; Date.now() < end; await pause(100)) await post(now);
      fs.rmSync(active);
      assert.deepEqual(await unaccepted(), [], `period ${period}`);
    }
    now.child.kill("SIGTERM");
    await now.ended;
    return start();
  },
  async kills(service) {
    let now = service;
    for (let i = 0; i < 5; i += 1) {
      await pause(700);
      now.child.kill("SIGKILL");
      await now.ended;
      now = await start();
    }
    return now;
  },
};

const sameBits = (dir, whole) => /^mse +0$/m.test(run(lacuna, "compare", path.join(dir, "image.exr"), path.join(whole, "image.exr")).stdout);

fs.mkdirSync(disk, { recursive: true });
const mounted = process.env.LACUNA_MOUNTS === "1"
  && run("mount", "-t", "tmpfs", "-o", "size=96m,nr_inodes=4000", "tmpfs", disk).status === 0;
let service;
let failed = 1;
try {
  const wholes = Array.from({ length: kinds }, (_, kind) => {
    const file = path.join(places, `whole${kind}.json`);
    fs.writeFileSync(file, JSON.stringify(spec(kind)));
    const done = spawnSync(lacuna, ["render", file, "-q"], { cwd: places,
      env: { ...process.env, LACUNA_SCENES: scenes, LACUNA_DATA: places } });
    assert.equal(done.status, 0, String(done.stderr));
    return path.join(places, `whole${kind}.job`);
  });
  service = await start(["prlimit", "--nofile=1024:1024"]);
  let injected = 0;
  for (let round = 0; round < rounds; round += 1) {
    for (const [name, fault] of Object.entries(faults)) {
      for (let i = 0; i < 4; i += 1) wishes.push({ key: `${name.replaceAll(" ", "-")}-${round}-${i}`, kind: i % kinds });
      await post(service);
      const posting = (async () => { await pause(500); await post(service); })();
      const after = await fault(service);
      await posting;
      if (typeof after === "string") {
        leftOut.set(name, after);
      } else {
        service = after;
        injected += 1;
      }
      const { body } = await until(async () => {
        const answer = await ask(service, "/health");
        return answer.status === 200 && answer;
      }, `the service answers after ${name}`);
      console.log(`${name}: ${leftOut.get(name) ? `left out: ${leftOut.get(name)}` : `injected; health: ${JSON.stringify(body)}`}`);
    }
  }
  await until(async () => { await post(service); return sweep.id && wishes.every((w) => w.id); }, "all is accepted");
  const jobs = async () => (await ask(service, "/api/jobs?limit=1000")).body?.jobs ?? [];
  await until(async () => {
    const list = await jobs();
    return list.length >= wishes.length + sweep.runs && list.every((job) => ends.includes(job.state));
  }, "every job is over");
  const list = new Map((await jobs()).map((job) => [job.id, job]));
  const swept = (await ask(service, `/api/sweeps/${sweep.id}`)).body;
  const all = [...wishes.map((w) => [w.id, w.kind]), ...swept.runs.map((r) => [r.job, (r.cell - 1) % kinds])];
  const lost = all.filter(([id]) => list.get(id)?.state !== "done");
  const different = all.filter(([id, kind]) => list.get(id)?.state === "done" && !sameBits(path.join(disk, id), wholes[kind]));
  for (const [id] of lost) console.log(`lost: ${id}: ${JSON.stringify(list.get(id))}`);
  const doubled = list.size - all.length;
  console.log(`${injected} faults injected, ${leftOut.size} left out; ${all.length} jobs accepted, ${lost.length} lost, `
    + `${doubled} doubled, ${different.length} with other bits than undisturbed`);
  failed = lost.length + doubled + different.length;
} finally {
  service?.child.kill("SIGKILL");
  await service?.ended;
  await pause(3000);  // its renderers end
  if (mounted) run("umount", "-l", disk);
  fs.rmSync(places, { recursive: true, force: true });
}
process.exit(failed === 0 ? 0 : 1);
