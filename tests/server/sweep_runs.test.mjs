// How a sweep's runs come to be done: fed to the queue, cancelled, and gone on with after a kill.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";
import { folders, Service, until } from "./service.mjs";

const jobFolders = (service) =>
  fs.readdirSync(path.join(service.places.data, "jobs")).filter((name) => !name.startsWith(".")).sort();
const running = (sweep) => sweep.runs.filter((r) => r.state === "running").map((r) => r.run);

test("runs become jobs a few at a time, in their order, among other people's jobs", async (t) => {
  const service = await Service.start(folders(t), ["--max-jobs", "8"]);
  const { id, runs } = await service.postSweep("turn go", {
    axes: { "/integrator/max_depth": [2, 3, 4] }, seeds: 2 });
  await until(async () => (await service.json("/api/jobs")).total === 4, "as many wait as may");
  const other = await service.post("finish");
  assert.equal((await service.sweep(id)).runs[4].job, null);
  for (const [i, run] of runs.entries()) {
    if (i === 5) await service.reaches(other, "done");  // before the runs that were no jobs yet
    await service.runReaches(id, i, "running");
    const sweep = await service.sweep(id);
    assert.deepEqual(running(sweep), [run.run]);
    assert.equal(sweep.counts.queued, runs.length - 1 - i);
    assert.ok((await service.json(`/api/jobs?sweep=${id}&state=queued,running`)).total <= 4);
    service.open("go");
  }
  const done = await service.sweepReaches(id, "done");
  assert.deepEqual(jobFolders(service), [...done.runs.map((r) => r.job), other].sort());
});

test("the answers of a sweep that is over follow its runs", async (t) => {
  const service = await Service.start(folders(t));
  const { id } = await service.postSweep("finish", { seeds: 2 });
  const { runs } = await service.sweepReaches(id, "done");
  const states = async () => (await service.json(`/api/sweeps/${id}/answers`)).states;
  const done = await states();
  assert.deepEqual(await states(), done);
  for (const { job } of runs) {  // in turn, so that the latest change stays, and then goes
    const before = await states();
    assert.equal((await service.fetch(`/api/jobs/${job}`, { method: "DELETE" })).status, 204);
    assert.notDeepEqual(await states(), before, "a run has gone");
  }
});

test("half of the queue's room is left to other jobs", async (t) => {
  const service = await Service.start(folders(t), ["--max-jobs", "6"]);
  const first = await service.postSweep("gate one", { seeds: 5 });
  const second = await service.postSweep("gate one", { seeds: 5 });
  await until(async () => (await service.json("/api/jobs")).total === 3, "as many wait as may");
  for (let i = 0; i < 3; i += 1) await service.post("gate one");
  assert.equal((await service.postText(JSON.stringify({ scene: "room/scene.glb" }))).status, 429);
  assert.equal((await service.json("/api/jobs")).total, 6);
  service.open("one");
  for (const { id } of [first, second]) await service.sweepReaches(id, "done");
  assert.equal((await service.json("/api/jobs")).total, 13);
});

test("runs have the machine for themselves unless the sweep says otherwise", async (t) => {
  const service = await Service.start(folders(t), ["--jobs", "2"]);
  const alone = await service.postSweep("turn go", { seeds: 3 });
  for (const [i, run] of alone.runs.entries()) {
    await service.runReaches(alone.id, i, "running");
    assert.deepEqual(running(await service.sweep(alone.id)), [run.run]);
    service.open("go");
  }
  const first = await service.sweepReaches(alone.id, "done");
  const together = await service.postSweep("gate one", { seeds: 3, alone: false });
  await until(async () => running(await service.sweep(together.id)).length === 2, "two at a time");
  service.open("one");
  const second = await service.sweepReaches(together.id, "done");
  const jobs = await Promise.all([...first.runs, ...second.runs].map((r) => service.json(`/api/jobs/${r.job}`)));
  assert.deepEqual(jobs.map((j) => j.job.exclusive), [true, true, true, false, false, false]);
});

test("runs that fail or are cancelled do not stop a sweep", async (t) => {
  const service = await Service.start(folders(t));
  const failing = await service.postSweep("fail", { seeds: 3 });
  const sweep = await service.sweepReaches(failing.id, "done");
  assert.deepEqual([sweep.counts.failed, sweep.share], [3, 1]);
  const other = await service.postSweep("turn go", { seeds: 2 });
  await service.cancel(await service.runReaches(other.id, 0, "running"));
  await service.runReaches(other.id, 1, "running");
  service.open("go");
  const { counts } = await service.sweepReaches(other.id, "done");
  assert.deepEqual([counts.cancelled, counts.done], [1, 1]);
});

test("a cancelled sweep stops, and no run of it is made any more", async (t) => {
  const places = folders(t);
  let service = await Service.start(places);
  const { id } = await service.postSweep("turn go", { seeds: 40 });
  service.open("go");
  await service.runReaches(id, 0, "done");
  const second = await service.runReaches(id, 1, "running");
  const answer = await service.cancelSweep(id);
  assert.ok([200, 202].includes(answer.status));
  assert.ok(["cancelling", "cancelled"].includes((await answer.json()).state));
  await service.sweepReaches(id, "cancelled");
  assert.equal((await service.cancelSweep(id)).status, 200, "again: still cancelled");
  const check = async () => {
    const sweep = await service.sweep(id);
    const there = sweep.runs.filter((r) => r.state !== null);
    assert.deepEqual(there, sweep.runs.filter((r) => r.job !== null));
    assert.ok(there.length <= 33);
    assert.deepEqual([sweep.state, sweep.counts.done, sweep.counts.cancelled], ["cancelled", 1, there.length - 1]);
    assert.deepEqual(jobFolders(service), there.map((r) => r.job).sort());
    return there.map((r) => r.job);
  };
  const made = await check();
  assert.equal(made[1], second);
  for (const job of made.slice(2)) {
    assert.equal((await service.json(`/api/jobs/${job}`)).state.attempts, 0, "it never began");
  }
  await service.stop();
  service = await Service.start(places);
  await service.reaches(await service.post("finish"), "done");
  const other = (await service.json("/api/jobs?sweep=")).jobs[0].id;
  assert.equal((await service.fetch(`/api/jobs/${other}`, { method: "DELETE" })).status, 204);
  assert.deepEqual(await check(), made);
  const done = await service.postSweep("finish", { seeds: 1 });
  await service.sweepReaches(done.id, "done");
  assert.equal((await service.cancelSweep(done.id)).status, 409);
});

test("killed while it cancels, a sweep is cancelled when the service is back", async (t) => {
  const places = folders(t);
  let service = await Service.start(places, ["--grace", "60"]);
  const { id } = await service.postSweep("stubborn", { seeds: 40 });
  await service.runReaches(id, 0, "running");
  assert.equal((await service.cancelSweep(id)).status, 202);
  await service.stop("SIGKILL");
  assert.equal(service.stored(id, "sweeps").state, "cancelling");
  service = await Service.start(places, ["--grace", "0.1"]);
  const sweep = await service.sweepReaches(id, "cancelled");
  assert.ok(sweep.runs.every((r) => r.state === null || r.state === "cancelled"));
});

test("killed at any moment, a sweep goes on with no run lost or doubled", async (t) => {
  const places = folders(t);
  let service = await Service.start(places, ["--max-attempts", "1000"]);
  const { id } = await service.postSweep("finish", {
    axes: { "/integrator/max_depth": [2, 3] }, seeds: 12 });
  let over = false;
  for (let round = 0; round < 6 && !over; round += 1) {
    await pause(30 + 37 * round);
    await service.stop(round % 3 === 2 ? "SIGTERM" : "SIGKILL");
    service = await Service.start(places, ["--max-attempts", "1000"]);
    over = (await service.sweep(id)).state === "done";
  }
  const sweep = await service.sweepReaches(id, "done", 600000);  // 24 processes, on a machine that may be busy
  assert.equal(sweep.counts.done, 24);
  assert.equal(new Set(sweep.runs.map((r) => r.job)).size, 24);
  assert.deepEqual(jobFolders(service), sweep.runs.map((r) => r.job).sort());
  const names = fs.readdirSync(path.join(places.data, "jobs")).filter((n) => n.startsWith("."));
  assert.deepEqual(names, [], "no folder is left half-made");
});
