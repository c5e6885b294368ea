// Faults of the machine that pass: they cost no accepted job, and nobody has to help.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import net from "node:net";
import path from "node:path";
import { test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";
import { ownScenes, startReal } from "./real_service.mjs";
import { fakeRenderer, folders, Service, until } from "./service.mjs";

/// From now on the service may have so many descriptors: below what it has, each open fails.
function limitDescriptors(service, n) {
  const set = spawnSync("prlimit", ["--pid", service.child.pid, `--nofile=${n}:`]);
  assert.equal(set.status, 0, String(set.stderr));
}

test("jobs whose folders cannot be locked wait, and go on by themselves", async (t) => {
  const service = await Service.start(folders(t), ["--max-attempts", "1"]);
  const ids = [await service.post("gate go")];
  await service.reaches(ids[0], "running");
  for (let i = 0; i < 10; i += 1) ids.push(await service.post("finish"));
  limitDescriptors(service, 3);
  service.open("go");
  await until(() => service.log.includes("jobs wait: "), "a folder could not be locked");
  await pause(1000);  // so that several are tried
  limitDescriptors(service, 1024);
  for (const id of ids) {
    const { state } = await service.reaches(id, "done", 60000);
    assert.deepEqual([state.attempts, state.obstacle], [1, ""]);
  }
  assert.deepEqual(await service.json("/health"), { status: "ok" });
});

test("a renderer without room is no crash: its job says what it waits for", async (t) => {
  const service = await Service.start(folders(t), ["--max-attempts", "1"]);
  const reasons = { full: /No space left on device/, mute: /could not write its files/ };
  for (const [word, reason] of Object.entries(reasons)) {
    const id = await service.post(`${word} ${word}.room`);
    // While a renderer starts, nothing keeps the job for a moment.
    const waits = (job) => job.state === "queued" && job.attempts > 1 && job.obstacle !== "" && job;
    const job = await until(async () => waits((await service.json(`/api/jobs/${id}`)).state), "it waits again", 60000);
    assert.match(job.obstacle, reason);
    assert.equal(job.error, "");
    const listed = await until(async () => {
      const { jobs } = await service.json("/api/jobs");
      return waits(jobs.find((other) => other.id === id));
    }, "the list says so, too", 60000);
    assert.match(listed.obstacle, reason);
    service.open(`${word}.room`);
    await service.reaches(id, "done", 60000);
  }
});

test("health says that jobs wait, and why, without the name of a file", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("full later");
  const health = await until(async () => {
    const seen = await service.json("/health");
    return seen.status === "waiting" && seen;
  }, "it waits");
  assert.match(health.obstacle, /cannot use their files/);
  service.open("later");
  await service.reaches(id, "done", 60000);
  assert.deepEqual(await service.json("/health"), { status: "ok" });
});

test("scenes that are away for a moment are waited for; scenes that have changed are not mixed", async (t) => {
  const places = folders(t);
  const own = path.join(places.scenes, "own.glb");
  fs.copyFileSync(path.join(ownScenes, "furnace.glb"), own);
  const service = await startReal(places, ["--max-attempts", "1"]);
  const spec = { scene: "own.glb", resolution: [8, 8], threads: 1, budget: { iterations: 2 } };
  const post = (target, body) => service.fetch(target, { method: "POST",
    headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
  const first = await service.post("long", { ...spec, budget: { seconds: 600 } });
  await until(async () => (await service.json(`/api/jobs/${first}`)).progress?.iteration > 0, "it renders");
  const id = await service.post("next", spec);
  const away = `${places.scenes}.away`;
  fs.renameSync(places.scenes, away);
  fs.mkdirSync(places.scenes);
  assert.equal((await post("/api/jobs", spec)).status, 503);
  await post(`/api/jobs/${first}/cancel`, {});
  const waits = await until(async () => {
    const { state } = await service.json(`/api/jobs/${id}`);
    return state.state === "queued" && state.attempts > 1 && state;
  }, "it waits");
  assert.match(waits.obstacle, /cannot read .*own\.glb: .*scenes is missing or empty/);
  fs.rmdirSync(places.scenes);
  fs.renameSync(away, places.scenes);
  await service.reaches(id, "done", 60000);

  const scene = fs.readFileSync(own);
  fs.writeFileSync(own, String(scene.toString("latin1")).replace("0.5", "0.4"), "latin1");
  assert.equal((await post(`/api/jobs/${id}/extend`, { budget: { iterations: 4 } })).status, 200);
  const { state } = await service.reaches(id, "failed", 60000);
  assert.match(state.error, /scene "own\.glb" has changed contents of the same size/);
  assert.ok(fs.existsSync(path.join(service.folder(id), "image.exr")));
});

test("what cannot be stored is refused and leaves everything where it was", async (t) => {
  const places = folders(t);
  const service = await Service.start(places);
  const first = await service.post("gate go");
  await service.reaches(first, "running");
  const id = await service.post("finish");
  const before = await service.json(`/api/jobs/${id}`);
  const patch = (change) => service.fetch(`/api/jobs/${id}`, { method: "PATCH",
    headers: { "Content-Type": "application/json" }, body: JSON.stringify(change) });
  const limitFiles = (bytes) => assert.equal(
    spawnSync("prlimit", ["--pid", service.child.pid, `--fsize=${bytes}:`]).status, 0);
  limitFiles(1);  // no file may grow
  for (const change of [{ held: true }, { priority: 3 }]) assert.equal((await patch(change)).status, 507);
  assert.equal((await service.cancel(id)).status, 507);
  const keyed = () => service.postText(JSON.stringify({ scene: "room/scene.glb", label: "finish" }),
    { "Content-Type": "application/json", "Idempotency-Key": "once" });
  assert.equal((await keyed()).status, 507);
  assert.deepEqual(await service.json(`/api/jobs/${id}`), before);
  assert.equal((await service.json("/api/jobs")).total, 2);
  limitFiles("unlimited");
  await service.stop("SIGKILL");  // what was refused is not found either
  const second = await Service.start(places);
  assert.equal((await second.json("/api/jobs")).total, 2);
  assert.deepEqual((await second.json(`/api/jobs/${id}`)).state.state, "queued");
  second.open("go");
  await second.reaches(id, "done", 60000);
});

test("a job's file and folder are made again from what was accepted", async (t) => {
  const places = folders(t);
  const post = (service) => service.postText(JSON.stringify({ scene: "room/scene.glb", label: "gate go" }),
    { "Content-Type": "application/json", "Idempotency-Key": "once" });
  const first = await Service.start(places);
  const running = await first.post("gate go");
  await first.reaches(running, "running");
  const { id, job } = await (await post(first)).json();
  const other = await first.post("finish");
  await first.stop("SIGKILL");
  fs.rmSync(first.folder(other), { recursive: true });
  fs.writeFileSync(path.join(first.folder(id), "job.json"), "{\"scene\":");

  const second = await Service.start(places);
  const again = await post(second);
  assert.deepEqual([again.status, again.headers.get("idempotent-replayed")], [200, "true"]);
  assert.deepEqual((await again.json()).job, job);
  second.open("go");
  await second.reaches(id, "done", 60000);
  await second.reaches(other, "done", 60000);
  assert.deepEqual(JSON.parse(fs.readFileSync(path.join(second.folder(id), "job.json"))), job);
});

test("a job that is done can be removed at once", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("linger");
  await until(async () => (await service.json(`/api/jobs/${id}`)).state.state === "done", "it is done");
  const gone = await service.fetch(`/api/jobs/${id}`, { method: "DELETE" });
  assert.equal(gone.status, 204, await gone.text());
});

test("without descriptors a scene is not called missing", async (t) => {
  const service = await Service.start(folders(t));
  // Connections keep what they have; only what is opened for a request fails.
  const agent = fs.readdirSync(`/proc/${service.child.pid}/fd`).map(Number);
  const body = JSON.stringify({ scene: "room/scene.glb", label: "finish" });
  const text = `POST /api/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: ${body.length}\r\n\r\n`;
  const socket = net.connect(service.port, "127.0.0.1");
  t.after(() => socket.destroy());
  let answer = "";
  socket.on("data", (d) => { answer += d; });
  socket.write(text);
  await until(() => fs.readdirSync(`/proc/${service.child.pid}/fd`).length > agent.length, "it is accepted");
  limitDescriptors(service, 3);
  socket.write(body);
  await until(() => answer.includes("\r\n\r\n"), "it is answered");
  limitDescriptors(service, 1024);
  assert.match(answer, /^HTTP\/1\.1 503 .*Retry-After: 1/s);
  await service.reaches(await service.post("finish"), "done");
});

/// Connections that send half a request and wait.
function halfRequests(t, service, n) {
  const sockets = Array.from({ length: n }, () => {
    const socket = net.connect(service.port, "127.0.0.1");
    socket.on("error", () => {});
    socket.write("GET /health HTTP/1.1\r\n");
    return socket;
  });
  t.after(() => sockets.forEach((socket) => socket.destroy()));
}

test("more half requests than connections take no descriptors from the jobs, nor keep others out for long", async (t) => {
  const service = await Service.start(folders(t), ["--max-attempts", "1"], ["prlimit", "--nofile=128:128"]);
  const ids = [await service.post("gate go")];
  await service.reaches(ids[0], "running");
  for (let i = 0; i < 5; i += 1) ids.push(await service.post("finish"));
  halfRequests(t, service, 70);
  service.open("go");
  for (const id of ids) await service.reaches(id, "done", 60000);
  assert.ok(!service.log.includes("Too many open files"), service.log);
  await service.reaches(await service.post("finish"), "done", 60000);
});

test("temporary files of killed writes are swept at the start", async (t) => {
  const places = folders(t);
  const first = await Service.start(places);
  const id = await first.post("finish");
  await first.reaches(id, "done");
  await first.stop();
  const left = [first.folder(id), places.data].map((dir) => path.join(dir, ".outcome.json.4194304-0123456789abcdef.tmp"));
  for (const file of left) {
    fs.writeFileSync(file, "half");
    fs.utimesSync(file, new Date(0), new Date(0));
  }
  await Service.start(places);
  await until(() => left.every((file) => !fs.existsSync(file)), "they are gone", 60000);
});

test("a renderer that is away, being written or cut off is one obstacle of all jobs, and ends none", async (t) => {
  const places = folders(t);
  const renderer = path.join(places.root, "renderer");
  const program = fs.readFileSync(fakeRenderer);
  const put = (content) => {
    fs.writeFileSync(`${renderer}.new`, content, { mode: 0o755 });
    fs.renameSync(`${renderer}.new`, renderer);
  };
  put(program);
  const service = await Service.start(places, ["--max-attempts", "1", "--renderer", renderer]);
  const faults = [
    () => fs.rmSync(renderer),
    () => put("#!/nowhere/node\n"),
    () => put("#!/bin/sh\nexec /nowhere/lacuna\n"),  // 127, as of a library that is missing
    () => put(fs.readFileSync(process.execPath).subarray(0, 1 << 20)),
  ];
  for (const fault of faults) {
    fault();
    const ids = [];
    for (let i = 0; i < 3; i += 1) ids.push(await service.post("finish"));
    const health = await until(async () => {
      const seen = await service.json("/health");
      return seen.status === "waiting" && seen;
    }, "the queue waits");
    assert.match(health.obstacle, /renderers cannot be started/);
    await until(async () => (await service.json("/api/jobs")).jobs.some((job) => job.obstacle !== ""), "a job says why");
    put(program);
    for (const id of ids) {
      const { state } = await service.reaches(id, "done", 60000);
      assert.deepEqual([state.attempts, state.error, state.obstacle], [1, "", ""]);
    }
  }
});
