// What a person can ask for: priority, hold, retry, extend, delete; and that it is kept.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { folders, Service, until } from "./service.mjs";

const json = (body) => ({ headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
const patch = (service, id, body, headers = {}) => service.fetch(`/api/jobs/${id}`,
  { method: "PATCH", body: JSON.stringify(body), headers: { "Content-Type": "application/json", ...headers } });
const act = (service, id, what, body) => service.fetch(`/api/jobs/${id}/${what}`,
  { method: "POST", ...(body ? json(body) : {}) });
const remove = (service, id) => service.fetch(`/api/jobs/${id}`, { method: "DELETE" });
const onDisk = (service, id, name) => JSON.parse(fs.readFileSync(path.join(service.folder(id), name)));

/// Jobs in the order in which their renderers began.
const order = async (service, ids) => {
  const jobs = await Promise.all(ids.map((id) => service.reaches(id, "done")));
  return jobs.sort((a, b) => (a.state.started < b.state.started ? -1 : 1)).map((j) => j.id);
};

test("priority goes before age, and survives a restart", async (t) => {
  const places = folders(t);
  const first = await Service.start(places);
  const blocker = await first.post("gate go");
  await first.reaches(blocker, "running");
  const [a, b, c] = [await first.post("finish"), await first.post("finish"), await first.post("finish")];
  const changed = await patch(first, c, { priority: 7 });
  assert.equal(changed.status, 200);
  assert.equal((await changed.json()).priority, 7);
  await patch(first, a, { priority: -1 });
  assert.equal((await patch(first, b, { priority: 101 })).status, 400);
  assert.equal((await patch(first, b, { prio: 1 })).status, 400);
  await first.stop("SIGKILL");
  const second = await Service.start(places);
  second.open("go");
  const seen = await order(second, [a, b, c]);
  assert.deepEqual(seen, [c, b, a]);
  assert.equal((await patch(second, a, { priority: 3 })).status, 409, "it is over");
});

test("a held job waits until it is released, also after a restart", async (t) => {
  const places = folders(t);
  const first = await Service.start(places);
  const running = await first.post("gate go");
  await first.reaches(running, "running");
  const waiting = await first.post("finish");
  assert.equal((await (await patch(first, waiting, { held: true })).json()).state.state, "held");
  assert.equal((await patch(first, running, { held: true })).status, 200);
  const held = await first.reaches(running, "held");
  assert.equal(held.state.exit_code, 75, "its renderer was stopped");
  assert.ok(fs.existsSync(path.join(first.folder(running), "checkpoint.bin")));
  await first.stop("SIGKILL");

  const second = await Service.start(places);
  const other = await second.post("finish");
  await second.reaches(other, "done");
  for (const id of [running, waiting]) {
    assert.equal((await second.json(`/api/jobs/${id}`)).state.state, "held");
  }
  second.open("go");
  for (const id of [running, waiting]) {
    assert.equal((await patch(second, id, { held: false })).status, 200);
    await second.reaches(id, "done");
  }
  assert.ok(onDisk(second, running, "report.json").resumed);
  assert.equal((await second.cancel(running)).status, 409);
});

test("a held job can be cancelled", async (t) => {
  const service = await Service.start(folders(t));
  const running = await service.post("gate never");
  await service.reaches(running, "running");
  const id = await service.post("finish");
  await patch(service, id, { held: true });
  assert.equal((await service.cancel(id)).status, 200);
  assert.equal(onDisk(service, id, "outcome.json").state, "cancelled");
});

test("a cancel is kept when the service dies before the renderer has ended", async (t) => {
  const places = folders(t);
  const first = await Service.start(places, ["--grace", "30"]);
  const id = await first.post("stubborn");
  await first.reaches(id, "running");
  assert.equal((await first.cancel(id)).status, 202);
  await first.stop("SIGKILL");
  const second = await Service.start(places, ["--grace", "0.3"]);
  const job = await second.reaches(id, "cancelled");
  assert.equal(job.state.attempts, 1, "it was not started again");
});

test("a job that failed or was cancelled is tried again, from its checkpoint", async (t) => {
  const service = await Service.start(folders(t), ["--max-attempts", "1"]);
  const id = await service.post("crash once");
  await service.reaches(id, "failed");
  assert.equal((await act(service, id, "retry")).status, 200);
  const job = await service.reaches(id, "done");
  assert.equal(job.state.attempts, 2);
  assert.equal(job.state.error, "");
  assert.ok(onDisk(service, id, "report.json").resumed);
  assert.equal((await act(service, id, "retry")).status, 409, "done is done");

  const running = await service.post("gate later");
  await service.reaches(running, "running");
  assert.equal((await act(service, running, "retry")).status, 409);
  await service.cancel(running);
  await service.reaches(running, "cancelled");
  service.open("later");
  assert.equal((await act(service, running, "retry")).status, 200);
  await service.reaches(running, "done");
});

test("a job that is over goes on with a larger budget only", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("finish", { budget: { iterations: 4 } });
  await service.reaches(id, "done");
  const smaller = await act(service, id, "extend", { budget: { iterations: 3 } });
  assert.equal(smaller.status, 400);
  assert.equal((await smaller.json()).errors[0].pointer, "/budget/iterations");
  assert.equal((await act(service, id, "extend", { budgets: {} })).status, 400);
  assert.equal((await act(service, id, "extend")).status, 415);
  assert.equal(onDisk(service, id, "job.json").budget.iterations, 4);
  const before = (await service.json(`/api/jobs/${id}`)).state.attempts;
  const larger = await act(service, id, "extend", { budget: { iterations: 8 } });
  assert.equal(larger.status, 200);
  assert.equal((await larger.json()).job.budget.iterations, 8);
  await until(async () => (await service.json(`/api/jobs/${id}`)).state.attempts > before, "it goes on");
  await service.reaches(id, "done");
  assert.equal(onDisk(service, id, "job.json").budget.iterations, 8);
});

test("only a job that is over is removed, and none that another measures itself against", async (t) => {
  const service = await Service.start(folders(t));
  const reference = await service.post("finish");
  await service.reaches(reference, "done");
  const user = await service.post("gate go", { reference });
  await service.reaches(user, "running");
  assert.equal((await remove(service, user)).status, 409, "it runs");
  const refused = await remove(service, reference);
  assert.equal(refused.status, 409);
  assert.ok((await refused.json()).detail.includes(user));
  service.open("go");
  await service.reaches(user, "done");
  for (const id of [reference, user]) {
    assert.equal((await remove(service, id)).status, 204);
    assert.equal((await service.fetch(`/api/jobs/${id}`)).status, 404);
    assert.ok(!fs.existsSync(service.folder(id)));
  }
  assert.equal((await remove(service, user)).status, 404);
  assert.deepEqual((await service.json("/api/jobs")).jobs, []);
  await until(() => fs.readdirSync(path.dirname(service.folder(user))).length === 0, "nothing is left");
});

test("who has not seen the latest state changes nothing", async (t) => {
  const service = await Service.start(folders(t));
  const running = await service.post("gate never");
  await service.reaches(running, "running");
  const id = await service.post("finish");
  const seen = (await service.fetch(`/api/jobs/${id}`)).headers.get("etag");
  assert.equal((await service.fetch(`/api/jobs/${id}`, { headers: { "If-None-Match": seen } })).status, 304);
  assert.equal((await patch(service, id, { priority: 2 }, { "If-Match": seen })).status, 200);
  assert.equal((await patch(service, id, { priority: 3 }, { "If-Match": seen })).status, 412);
  assert.equal((await patch(service, id, { priority: 4 }, { "If-Match": "*" })).status, 200);
  assert.equal((await patch(service, id, { priority: 5 }, { "If-Match": "nonsense" })).status, 400);
  assert.equal((await service.json(`/api/jobs/${id}`)).priority, 4);
});

test("a cancel, a retry, an extension and a removal are refused after a change that was not seen", async (t) => {
  const service = await Service.start(folders(t));
  const running = await service.post("gate never");
  await service.reaches(running, "running");
  const id = await service.post("finish");
  const etag = async () => (await service.fetch(`/api/jobs/${id}`)).headers.get("etag");
  const old = await etag();
  const ask = async (method, what, seen, body) => (await service.fetch(`/api/jobs/${id}${what}`, { method,
    body: body && JSON.stringify(body), headers: { "If-Match": seen, "Content-Type": "application/json" } })).status;
  const stands = async (state) => assert.equal((await service.json(`/api/jobs/${id}`)).state.state, state);
  assert.equal((await patch(service, id, { priority: 2 })).status, 200);
  assert.equal(await ask("POST", "/cancel", old), 412);
  await stands("queued");
  assert.equal(await ask("POST", "/cancel", await etag()), 200);
  assert.equal(await ask("POST", "/retry", old), 412);
  assert.equal(await ask("POST", "/extend", old, { budget: { seconds: 1000 } }), 412);
  assert.equal(await ask("DELETE", "", old), 412);
  await stands("cancelled");
  assert.equal(await ask("DELETE", "", await etag()), 204);
});

test("the same key and body make one job, also at once and after a restart", async (t) => {
  const places = folders(t);
  const first = await Service.start(places);
  const headers = { "Content-Type": "application/json", "Idempotency-Key": "my-job-1" };
  const body = JSON.stringify({ scene: "room/scene.glb", label: "finish" });
  const answers = await Promise.all(Array.from({ length: 8 }, () => first.postText(body, headers)));
  const ids = new Set(await Promise.all(answers.map(async (a) => (await a.json()).id)));
  assert.equal(ids.size, 1);
  assert.equal(answers.filter((a) => a.status === 201).length, 1);
  assert.equal(answers.filter((a) => a.headers.get("idempotent-replayed") === "true").length, 7);
  await first.stop("SIGKILL");
  const second = await Service.start(places);
  const again = await second.postText(body, headers);
  assert.equal(again.status, 200);
  assert.ok(ids.has((await again.json()).id));
  const other = JSON.stringify({ scene: "room/scene.glb", label: "finish", seed: 2 });
  assert.equal((await second.postText(other, headers)).status, 422);
  assert.equal((await second.postText(body, { ...headers, "Idempotency-Key": "a b" })).status, 400);
  assert.equal((await second.json("/api/jobs")).total, 1);
});

test("a dry run says what the job would be, and stores nothing", async (t) => {
  const service = await Service.start(folders(t));
  const dry = (body) => service.fetch("/api/jobs?dry_run=1", { method: "POST", ...json(body) });
  const good = await dry({ scene: "room/scene.glb" });
  assert.equal(good.status, 200);
  assert.equal((await good.json()).job.seed, 1);
  const bad = await dry({ scene: "room/scene.glb", sed: 3 });
  assert.equal(bad.status, 400);
  assert.equal((await bad.json()).errors[0].pointer, "/sed");
  assert.equal((await service.json("/api/jobs")).total, 0);
});

test("an exclusive job runs alone, and none overtakes it", async (t) => {
  const service = await Service.start(folders(t), ["--jobs", "3"]);
  const first = await service.post("gate one");
  await service.reaches(first, "running");
  const alone = await service.post("gate two", { exclusive: true });
  const after = await service.post("gate three");
  const states = async () => Promise.all([first, alone, after].map(
    async (id) => (await service.json(`/api/jobs/${id}`)).state.state));
  assert.deepEqual(await states(), ["running", "queued", "queued"]);
  service.open("one");
  await service.reaches(alone, "running");
  assert.deepEqual(await states(), ["done", "running", "queued"]);
  service.open("two");
  await service.reaches(after, "running");
  service.open("three");
  await service.reaches(after, "done");
});

test("the line has an end", async (t) => {
  const service = await Service.start(folders(t), ["--max-jobs", "2"]);
  await service.post("gate never");
  await service.post("finish");
  const refused = await service.postText(JSON.stringify({ scene: "room/scene.glb" }));
  assert.equal(refused.status, 429);
  assert.ok(refused.headers.get("retry-after"));
});

test("without room on the disk, jobs wait; with it, they go on", async (t) => {
  const places = folders(t);
  const first = await Service.start(places, ["--disk-floor", "900000T"]);
  const id = await first.post("finish");
  // A runner looks at the disk before it takes a job, the maintenance thread only once a second.
  const { obstacle } = await until(async () => {
    const health = await first.json("/health");
    return health.status === "waiting" && health;
  }, "the lack of room is noticed");
  assert.match(obstacle, /are free on the disk, the floor is/);
  assert.equal((await first.json(`/api/jobs/${id}`)).state.state, "queued");
  const { disk } = await first.json("/api/info");
  assert.ok(disk.free_bytes < disk.floor_bytes);
  await first.stop();
  assert.equal(first.stored(id).attempts, 0);
  assert.ok(!fs.existsSync(path.join(first.folder(id), "log.txt")), "no renderer was started");
  const second = await Service.start(places);
  await second.reaches(id, "done");
});
