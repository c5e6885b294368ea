// A sweep's life over HTTP: posted, listed, its runs, its table, and what is refused.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { binary, folders, Service, sweepFile, until } from "./service.mjs";

const depths = { axes: { "/integrator/max_depth": [4, 8] }, seeds: 2,
  baseline: { "/integrator/max_depth": 4 } };
const lacuna = path.join(path.dirname(binary), "lacuna");
const namesIn = (folder) => fs.readdirSync(folder).filter((name) => !name.startsWith("."));

async function refused(service, body, headers) {
  const answer = await service.postSweepText(typeof body === "string" ? body : JSON.stringify(body), headers);
  return { status: answer.status, ...await answer.json() };
}

test("a sweep's runs are jobs, in its order; one table joins their curves", async (t) => {
  const service = await Service.start(folders(t));
  const other = await service.post("finish");
  const answer = await service.postSweepText(JSON.stringify(sweepFile("finish", depths)));
  assert.equal(answer.status, 201);
  const posted = await answer.json();
  assert.equal(answer.headers.get("location"), `/api/sweeps/${posted.id}`);
  assert.deepEqual(namesIn(service.sweepFolder(posted.id)), ["state.json", "sweep.json"]);
  assert.equal(posted.spec.alone, true, "defaults are filled in");

  const sweep = await service.sweepReaches(posted.id, "done");
  assert.ok(sweep.created && sweep.finished >= sweep.created);
  assert.deepEqual([sweep.label, sweep.run_count, sweep.cell_count, sweep.counts.done, sweep.share],
    ["finish", 4, 2, 4, 1]);
  assert.deepEqual(sweep.cells, [
    { text: "max_depth 4", settings: { "/integrator/max_depth": 4 }, baseline: 1 },
    { text: "max_depth 8", settings: { "/integrator/max_depth": 8 }, baseline: 1 }]);
  assert.deepEqual(sweep.runs.map((r) => [r.run, r.cell, r.replicate, r.state]), [
    ["0001-1", 1, 1, "done"], ["0002-1", 2, 1, "done"], ["0001-2", 1, 2, "done"], ["0002-2", 2, 2, "done"]]);
  const jobs = await Promise.all(sweep.runs.map((r) => service.json(`/api/jobs/${r.job}`)));
  assert.deepEqual(jobs.map((j) => [j.sweep, j.job.integrator.max_depth, j.job.seed, j.job.exclusive]),
    [[4, 1], [8, 1], [4, 2], [8, 2]].map(([depth, seed]) => [sweep.id, depth, seed, true]));
  const started = jobs.map((j) => j.state.started);
  assert.deepEqual(started, [...started].sort(), "one after the other");

  const runs = await service.json(`/api/jobs?sweep=${sweep.id}&limit=3`);
  assert.deepEqual([runs.total, runs.jobs.length, runs.jobs[0].sweep], [4, 3, sweep.id]);
  const rest = await service.json(`/api/jobs?sweep=${sweep.id}&limit=3&cursor=${encodeURIComponent(runs.next)}`);
  assert.deepEqual([rest.jobs.length, rest.next], [1, null]);
  const alone = await service.json("/api/jobs?sweep=");
  assert.deepEqual([alone.total, alone.jobs[0].id, alone.jobs[0].sweep], [1, other, null]);
  assert.equal((await service.json(`/api/jobs?sweep=${sweep.id}&state=failed`)).total, 0);
  assert.equal((await service.fetch("/api/jobs?sweep=me")).status, 400);

  const table = await service.fetch(`/api/sweeps/${sweep.id}/table.csv`);
  assert.equal(table.headers.get("content-type"), "text/csv");
  assert.equal(await table.text(), "run,cell,baseline,replicate,seed,state,/integrator/max_depth,iteration,seconds,est_rmse\n"
    + "0001-1,1,1,1,1,done,4,100,1,0.5\n0002-1,2,1,1,1,done,8,100,1,0.5\n"
    + "0001-2,1,1,2,2,done,4,100,1,0.5\n0002-2,2,1,2,2,done,8,100,1,0.5\n");
  const again = await service.fetch(`/api/sweeps/${sweep.id}/table.csv`,
    { headers: { "If-None-Match": table.headers.get("etag") } });
  assert.equal(again.status, 304);

  const second = await service.postSweep("finish", { seeds: 1 });
  const { sweeps } = await service.json("/api/sweeps");
  assert.deepEqual(new Set(sweeps.map((s) => s.id)), new Set([second.id, sweep.id]));
  assert.equal(sweeps.find((s) => s.id === sweep.id).counts.done, 4);
  assert.equal((await service.fetch("/api/sweeps/20260131-235959-k3x9qa")).status, 404);
  assert.ok((await service.json("/api/schema/sweep")).properties.axes);
});

test("a dry run tells the cells and creates nothing", async (t) => {
  const service = await Service.start(folders(t));
  const answer = await service.postSweepText(JSON.stringify(sweepFile("", depths)), {}, "?dry_run=1");
  assert.equal(answer.status, 200);
  const plan = await answer.json();
  assert.deepEqual([plan.cell_count, plan.run_count, plan.cells.map((c) => c.text)],
    [2, 4, ["max_depth 4", "max_depth 8"]]);
  assert.equal(plan.spec.order, "interleave");
  const bad = await service.postSweepText(JSON.stringify(sweepFile("", { seeds: 0 })), {}, "?dry_run=1");
  assert.equal(bad.status, 400);
  assert.deepEqual(namesIn(path.join(service.places.data, "sweeps")), []);
  assert.deepEqual((await service.json("/api/sweeps")).sweeps, []);
});

test("a bad sweep is refused with the places of its mistakes", async (t) => {
  const service = await Service.start(folders(t));
  const pointers = async (sweep) => {
    const answer = await refused(service, sweep);
    assert.equal(answer.status, 400, JSON.stringify(answer));
    return answer.errors.map((e) => e.pointer);
  };
  assert.deepEqual(await pointers(sweepFile("", { seeds: 0, colour: 1 })), ["/seeds", "/colour"]);
  assert.deepEqual(await pointers(sweepFile("", { axes: { "/integrator/max_depth": [4, 0] } })),
    ["/axes/~1integrator~1max_depth/1"]);
  assert.deepEqual(await pointers(sweepFile("", { axes: { "/resolution/2": [4] } })), ["/axes/~1resolution~12"]);
  assert.deepEqual(await pointers({ job: { scene: "room/scene.glb", treads: 2 } }), ["/job/treads"]);
  const missing = await refused(service, { job: { environment: { file: "sky.hdr" } }, seeds: 5,
    zip: [{ "/scene": ["room/scene.glb", "no.glb"], "/camera": ["a", "b"] }] });
  assert.deepEqual(missing.errors.map((e) => e.pointer), ["/job/environment/file", "/zip/0/~1scene/1"]);
  assert.match(missing.errors[1].message, /room\/scene\.glb/, "what there is");
  assert.equal((await refused(service, "{")).status, 400);
  assert.equal((await refused(service, "{}", { "Content-Type": "text/plain" })).status, 415);
  const large = sweepFile("", { job: { scene: "x".repeat(5 << 20) } });
  assert.equal((await refused(service, large)).status, 413);
  assert.deepEqual(namesIn(path.join(service.places.data, "sweeps")), []);
});

test("a sweep is made once for a key, also after a restart", async (t) => {
  const places = folders(t);
  let service = await Service.start(places);
  const body = JSON.stringify(sweepFile("finish", depths));
  const key = { "Idempotency-Key": "one" };
  const answers = await Promise.all(Array.from({ length: 4 }, () => service.postSweepText(body, key)));
  assert.deepEqual(answers.map((a) => a.status).sort(), [200, 200, 200, 201]);
  const ids = new Set(await Promise.all(answers.map(async (a) => (await a.json()).id)));
  assert.equal(ids.size, 1);
  await service.stop("SIGKILL");
  service = await Service.start(places);
  const again = await service.postSweepText(body, key);
  assert.deepEqual([again.status, again.headers.get("idempotent-replayed")], [200, "true"]);
  assert.ok(ids.has((await again.json()).id));
  const other = await refused(service, `${body} `, key);
  assert.equal(other.status, 422);
  assert.match(other.detail, /belongs to sweep/);
  assert.equal((await refused(service, body, { "Idempotency-Key": "a b" })).status, 400);
  assert.equal((await service.postText(JSON.stringify({ scene: "room/scene.glb" }),
    { "Content-Type": "application/json", ...key })).status, 201, "a job's keys are others");
  assert.equal((await service.json("/api/sweeps")).sweeps.length, 1);
});

test("what belongs to a sweep is removed with it, when it is over, and not before", async (t) => {
  const service = await Service.start(folders(t));
  const remove = async (target) => (await service.fetch(target, { method: "DELETE" })).status;
  const { id } = await service.postSweep("turn go", { seeds: 3 });
  service.open("go");
  const first = await service.runReaches(id, 0, "done");
  // A moment after its last word a renderer still runs: then that is the reason.
  await until(async () => {
    const answer = await service.fetch(`/api/jobs/${first}`, { method: "DELETE" });
    assert.equal(answer.status, 409);
    return (await answer.json()).detail.includes(`It is a run of sweep ${id}, which is not over`);
  }, "the reason is the sweep");
  assert.equal(await remove(`/api/sweeps/${id}`), 409);
  for (const run of [1, 2]) {
    await service.runReaches(id, run, "running");
    service.open("go");
  }
  const { runs } = await service.sweepReaches(id, "done");

  const other = await service.post("gate later", { reference: runs[1].job });
  assert.equal(await remove(`/api/sweeps/${id}`), 409, "a job measures its error against a run");
  assert.equal((await service.json(`/api/jobs?sweep=${id}`)).total, 3, "nothing is removed yet");
  service.open("later");
  await service.reaches(other, "done");
  await until(async () => await remove(`/api/jobs/${runs[2].job}`) === 204, "a run is removed");
  const left = await service.sweep(id);
  assert.deepEqual([left.state, left.counts.done, left.runs[2].state], ["done", 2, null]);
  assert.equal(left.runs[2].job, null);
  await until(async () => await remove(`/api/sweeps/${id}`) === 204, "the sweep is removed");
  assert.equal(await remove(`/api/sweeps/${id}`), 404);
  assert.deepEqual((await service.json("/api/jobs")).jobs.map((j) => j.id), [other]);
  assert.deepEqual(namesIn(path.join(service.places.data, "sweeps")), []);
  assert.deepEqual(namesIn(path.join(service.places.data, "jobs")), [other]);
});

test("the shell lists a sweep of the service, and leaves its runs to it", async (t) => {
  const service = await Service.start(folders(t));
  const { id } = await service.postSweep("turn go", depths);
  service.open("go");
  await service.runReaches(id, 0, "done");
  await service.reaches(await service.runReaches(id, 1, "running"), "running");
  const shell = (...args) => {
    const { status, stdout, stderr } = spawnSync(lacuna, ["sweep", `${service.sweepFolder(id)}/`, ...args],
      { cwd: service.places.root });
    return { status, out: String(stdout), err: String(stderr) };
  };
  assert.match(shell("--list").out, /^ +1 0001-1 +done +max_depth 4\n +2 0002-1 +running +max_depth 8$/m);
  assert.equal(shell("--missing").out, "2-4\n");
  const done = shell();
  assert.equal(done.status, 2);
  assert.match(done.err, /is a sweep of a service, which renders its runs/);
});
