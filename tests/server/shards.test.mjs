// Jobs with shards: the service has these rendered as the runs of a sweep, and merges them.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { folders, Service, until } from "./service.mjs";
import { lacuna, realFolders, startReal } from "./real_service.mjs";

const spec = { scene: "ajar.glb", resolution: [32, 24], threads: 1, budget: { iterations: 12 } };
const fake = { shards: 3, budget: { iterations: 12 } };
const shardIds = async (service, id) => {
  const { shards } = await service.json(`/api/jobs/${id}`);
  return (await service.sweep(shards)).runs.map((run) => run.job);
};
const report = (service, id) => JSON.parse(fs.readFileSync(path.join(service.folder(id), "report.json")));

function sameBits(service, a, b) {
  const [one, other] = [a, b].map((id) => path.join(service.folder(id), "image.exr"));
  const done = spawnSync(lacuna, ["compare", one, other], { encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
  assert.match(done.stdout, /^mse +0$/m);
}

test("a job with shards is merged from them: the bits of a job without", async (t) => {
  const service = await startReal(realFolders(t), ["--jobs", "2"]);
  const whole = await service.post("whole", spec);
  const id = await service.post("parts", { ...spec, shards: 3 });
  await service.reaches(whole, "done");
  await service.reaches(id, "done");
  sameBits(service, whole, id);
  assert.equal(report(service, id).merged.shards, 3);
  assert.equal(report(service, id).merged.same_bits_as_one_machine, true);
  const jobs = await shardIds(service, id);
  for (const [k, job] of jobs.entries()) {
    const shard = (await service.json(`/api/jobs/${job}`)).job;
    assert.deepEqual([shard.shard, shard.shards, shard.label], [k + 1, 3, `parts: shard ${k + 1}`]);
  }
  const list = await service.json("/api/jobs?sweep=");
  assert.deepEqual(list.jobs.map((job) => job.id).sort(), [whole, id].sort(), "the list shows no shards");

  // Extended, it goes on from its own checkpoint; the shards may be gone.
  const { shards } = await service.json(`/api/jobs/${id}`);
  await until(async () => (await service.sweep(shards)).state === "done", "the sweep is over");
  assert.equal((await service.fetch(`/api/sweeps/${shards}`, { method: "DELETE" })).status, 204);
  const extend = (job) => service.fetch(`/api/jobs/${job}/extend`, { method: "POST",
    headers: { "Content-Type": "application/json" }, body: JSON.stringify({ budget: { iterations: 20 } }) });
  for (const job of [whole, id]) assert.equal((await extend(job)).status, 200);
  for (const job of [whole, id]) {
    await until(async () => (await service.json(`/api/jobs/${job}`)).progress.iteration === 20, "it goes on");
    await service.reaches(job, "done");
  }
  sameBits(service, whole, id);
});

test("a shard that was cancelled fails the job by name; retried, both are done", async (t) => {
  const service = await startReal(realFolders(t));
  const first = await service.post("keeps the others waiting", { ...spec, budget: { seconds: 600 } });
  const id = await service.post("parts", { ...spec, shards: 2 });
  const [one, two] = await until(async () => {
    const ids = await shardIds(service, id);
    return ids.every(Boolean) && ids;
  }, "its shards are made");
  await service.cancel(one);
  assert.equal((await service.json(`/api/jobs/${one}`)).state.state, "cancelled");
  assert.match((await service.json(`/api/jobs/${id}`)).state.place, /waiting for its shards, the runs of/);
  await service.cancel(first);
  await service.reaches(two, "done");
  const failed = await service.reaches(id, "failed");
  assert.match(failed.state.error, new RegExp(`${one}: shard 1 of 2 is cancelled, not done`));
  // While the job is not over, its shards are kept.
  const retry = async (job) => assert.equal((await service.fetch(`/api/jobs/${job}/retry`, { method: "POST" })).status, 200);
  await retry(one);
  await retry(id);
  assert.equal((await service.fetch(`/api/jobs/${two}`, { method: "DELETE" })).status, 409);
  await service.reaches(id, "done");
  assert.equal(report(service, id).merged.shards, 2);
});

test("a service that is killed finds the job and its shards, also without their sweep", async (t) => {
  const places = folders(t);
  const first = await Service.start(places, ["--jobs", "2"]);
  const id = await first.post("gate go", fake);
  const { shards } = await first.json(`/api/jobs/${id}`);
  await until(async () => (await first.sweep(shards)).runs.every((run) => run.job), "its shards are made");
  await first.stop("SIGKILL");
  // As after a kill between the job's folder and its sweep's.
  fs.rmSync(first.sweepFolder(shards), { recursive: true });
  const second = await Service.start(places, ["--jobs", "2"]);
  await until(async () => (await second.fetch(`/api/sweeps/${shards}`)).status === 200, "the sweep is made again");
  const jobs = await shardIds(second, id);
  await until(async () => (await second.sweep(shards)).runs.some((run) => run.state === "running"), "shards go on");
  assert.equal((await second.json(`/api/jobs/${id}`)).state.state, "queued");
  second.open("go");
  for (const job of [...jobs, id]) await second.reaches(job, "done");
  assert.equal((await second.json("/api/jobs")).total, 4, "none is doubled");
});

test("a job that is cancelled stops its shards", async (t) => {
  const service = await Service.start(folders(t), ["--jobs", "2"]);
  const id = await service.post("gate never", fake);
  const { shards } = await service.json(`/api/jobs/${id}`);
  await until(async () => (await service.sweep(shards)).runs.some((run) => run.state === "running"), "a shard runs");
  await service.cancel(id);
  await service.reaches(id, "cancelled");
  await service.sweepReaches(shards, "cancelled");
});

test("the number of shards is checked, and a shard by itself is an ordinary job", async (t) => {
  const service = await Service.start(folders(t));
  const refused = async (more, pattern) => {
    const answer = await service.postText(JSON.stringify({ scene: "room/scene.glb", ...more }));
    assert.equal(answer.status, 400);
    const [problem] = (await answer.json()).errors;
    assert.equal(problem.pointer, "/shards");
    assert.match(problem.message, pattern);
  };
  await refused({ shards: 7, budget: { iterations: 12 } }, /found 7; allowed: 1 to 6/);
  await refused({ shards: 20001 }, /found 20001; allowed: 1 to 20000/);
  const id = await service.post("finish", { shards: 2, shard: 1, budget: { iterations: 12 } });
  const job = await service.reaches(id, "done");
  assert.equal(job.shards, null);
});
