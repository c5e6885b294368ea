// The service, its renderers, or both are killed at any moment, again and again, while jobs are posted, cancelled, held
// and extended: no job that was accepted is lost or doubled, none that was cancelled is rendered, no file is half-written,
// and the pictures have the bits of jobs that nobody disturbed. So with the runs of a sweep, of the service and of `lacuna
// sweep`. LACUNA_KILLS: rounds (3 in a quick run, 300 in a long one).
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";
import { fileURLToPath } from "node:url";
import { binary, folders, Service, until } from "../server/service.mjs";

const rounds = Number(process.env.LACUNA_KILLS ?? 3);
const lacuna = path.join(path.dirname(binary), "lacuna");
const scenes = path.join(path.dirname(fileURLToPath(import.meta.url)), "../../jobs/scenes");
const ends = ["done", "failed", "cancelled"];
// Each kill of a renderer counts as its crash.
const options = ["--renderer", lacuna, "--jobs", "2", "--grace", "2", "--max-attempts", "1000", "--nice", "0"];

// Numbers that are the same in every run.
let seed = 1;
function random(n) {
  seed = (seed * 48271) % 2147483647;
  return seed % n;
}

const spec = (kind) => ({
  scene: "cornell.glb", resolution: [96, 96], seed: 1 + kind, threads: 1, layers: ["variance"],
  budget: { iterations: 30 + 10 * kind }, checkpoint_seconds: 0.05,
});
const kinds = 4;
const larger = (kind) => ({ iterations: spec(kind).budget.iterations + 25 });
const environment = (places) => ({ ...process.env, LACUNA_SCENES: scenes, LACUNA_DATA: places.root });

/// The pictures as they are when nobody disturbs, by the iterations of each kind.
function references(places) {
  const render = (name, job) => {
    const file = path.join(places.root, `${name}.json`);
    fs.writeFileSync(file, JSON.stringify(job));
    const done = spawnSync(lacuna, ["render", file, "-q"], { env: environment(places), cwd: places.root });
    assert.equal(done.status, 0, String(done.stderr));
    return path.join(places.root, `${name}.job`);
  };
  return Array.from({ length: kinds }, (_, kind) => ({
    [spec(kind).budget.iterations]: render(`whole${kind}`, spec(kind)),
    [larger(kind).iterations]: render(`larger${kind}`, { ...spec(kind), budget: larger(kind) }),
  }));
}

/// Whatever the service may do meanwhile: an answer, or nothing.
async function ask(service, target, request) {
  try {
    const response = await service.fetch(target, { ...request, signal: AbortSignal.timeout(5000) });
    return { status: response.status, body: await response.json() };
  } catch {
    return null;
  }
}

const post = (service, wish) => ask(service, "/api/jobs", {
  method: "POST", body: JSON.stringify({ ...spec(wish.kind), label: wish.key }),
  headers: { "Content-Type": "application/json", "Idempotency-Key": wish.key },
});

/// Posts the wishes that have no answer yet, in their order; gives up when the service is gone.
async function postAll(service, wishes) {
  for (const wish of wishes.filter((w) => !w.id)) {
    const answer = await post(service, wish);
    if (!answer) return;
    assert.ok([200, 201].includes(answer.status), JSON.stringify(answer));
    wish.id = answer.body.id;
  }
}

/// A sweep whose runs are the kinds, each several times.
const kindsSweep = {
  job: { ...spec(0), label: "" }, alone: false,
  zip: [{ "/seed": Array.from({ length: kinds }, (_, kind) => spec(kind).seed),
    "/budget": Array.from({ length: kinds }, (_, kind) => spec(kind).budget) }],
  axes: { "/threads": [1, 2, 3] },
};

/// Posts it if it has no answer yet.
async function postSweep(service, sweep) {
  if (sweep.id) return;
  const answer = await ask(service, "/api/sweeps", { method: "POST", body: JSON.stringify(kindsSweep),
    headers: { "Content-Type": "application/json", "Idempotency-Key": "sweep" } });
  if (!answer) return;
  assert.ok([200, 201].includes(answer.status), JSON.stringify(answer));
  sweep.id = answer.body.id;
}

/// Cancels, holds or releases, or extends a job, if there is one.
async function disturbOne(service, wishes) {
  const known = wishes.filter((w) => w.id && !w.cancelled);
  if (known.length === 0) return;
  const wish = known[random(known.length)];
  const request = (method, target, body) => ask(service, `/api/jobs/${wish.id}${target}`,
    { method, body: JSON.stringify(body), headers: { "Content-Type": "application/json" } });
  const done = (answer) => answer !== null && [200, 202].includes(answer.status);
  switch (random(3)) {
    case 0:
      wish.mayBeCancelled = true;  // the answer may be lost
      wish.cancelled = done(await ask(service, `/api/jobs/${wish.id}/cancel`, { method: "POST" }));
      break;
    case 1: await request("PATCH", "", { held: random(2) === 0 }); break;
    default: wish.extended ||= done(await request("POST", "/extend", { budget: larger(wish.kind) }));
  }
}

/// Nobody knows which of the requests came before a kill: all are released that are held.
async function releaseAll(service, wishes) {
  for (const { id } of wishes) {
    if ((await service.json(`/api/jobs/${id}`)).state.state !== "held") continue;
    const answer = await ask(service, `/api/jobs/${id}`,
      { method: "PATCH", body: JSON.stringify({ held: false }), headers: { "Content-Type": "application/json" } });
    assert.equal(answer.status, 200, JSON.stringify(answer));
  }
}

function renderersOf(service) {
  try {
    return fs.readdirSync(`/proc/${service.child.pid}/task`).flatMap((task) =>
      fs.readFileSync(`/proc/${service.child.pid}/task/${task}/children`, "utf8").split(" ").filter(Boolean));
  } catch {
    return [];  // it has just ended
  }
}

/// Kills the service, a renderer, or both in either order. True: the service is gone.
function kill(service) {
  const what = random(4);
  const killAll = () => renderersOf(service).forEach((pid) => {
    try {
      process.kill(Number(pid), "SIGKILL");
    } catch { /* it has just ended */ }
  });
  if (what !== 1) service.child.kill("SIGKILL");
  if (what !== 0) killAll();
  return what !== 1;
}

/// Nothing in a job's folder is half-written; gives the state that it tells.
function checkFolder(dir) {
  const read = (name) => {
    const file = path.join(dir, name);
    return fs.existsSync(file) ? JSON.parse(fs.readFileSync(file, "utf8")) : null;
  };
  read("job.json");
  read("accepted.json");
  return read("outcome.json")?.state ?? "queued";
}

function sameBits(dir, reference) {
  const done = spawnSync(lacuna, ["compare", path.join(dir, "image.exr"), path.join(reference, "image.exr")]);
  assert.match(String(done.stdout), /^mse +0$/m, dir);
}

test(`${rounds} rounds of kill -9`, async (t) => {
  const places = { ...folders(t), scenes };
  const wholes = references(places);
  const wholeOf = (kind) => wholes[kind][spec(kind).budget.iterations];
  const wishes = [];
  const sweep = {};
  let service = await Service.start(places, options);
  let kills = 0;
  for (let i = 0; i < rounds; i += 1) {
    const more = random(3);
    for (let k = 0; k < more; k += 1) wishes.push({ key: `round-${i}-${k}`, kind: random(kinds) });
    const posting = Promise.all([postAll(service, wishes), postSweep(service, sweep)]);
    const disturbing = random(3) === 0 ? disturbOne(service, wishes) : null;
    await pause(random(10) < 3 ? random(30) : random(900));
    if (kill(service)) {
      kills += 1;
      await service.ended;
      await Promise.all([posting, disturbing]);
      for (const id of fs.readdirSync(path.join(places.data, "jobs")).filter((n) => !n.startsWith("."))) {
        checkFolder(path.join(places.data, "jobs", id));
      }
      service = await Service.start(places, options);
    } else {
      await Promise.all([posting, disturbing]);
    }
  }
  await postAll(service, wishes);
  await postSweep(service, sweep);
  assert.ok(wishes.every((w) => w.id));
  await releaseAll(service, wishes);
  const list = async () => {
    const jobs = [];
    for (let next = ""; next !== null;) {
      const page = await service.json(`/api/jobs?limit=1000${next && `&cursor=${encodeURIComponent(next)}`}`);
      jobs.push(...page.jobs);
      next = page.next;
    }
    return jobs;
  };
  const swept = await service.sweepReaches(sweep.id, "done", 600000);
  await until(async () => (await list()).every((job) => ends.includes(job.state)),
    "every job is over", 600000);

  const jobs = await list();
  assert.equal(jobs.length, wishes.length + 3 * kinds, "none is lost or doubled");
  assert.equal((await service.json("/api/sweeps")).sweeps.length, 1);
  assert.equal(swept.counts.done, 3 * kinds);
  for (const run of swept.runs) sameBits(service.folder(run.job), wholeOf((run.cell - 1) % kinds));
  let done = 0;
  for (const wish of wishes) {
    const job = jobs.find((j) => j.id === wish.id);
    assert.equal(job?.label, wish.key);
    assert.notEqual(job.state, "failed", job.error);
    if (job.state === "cancelled") assert.ok(wish.mayBeCancelled, "nobody had asked for that");
    const dir = service.folder(wish.id);
    assert.equal(checkFolder(dir), job.state);
    if (job.state !== "done") continue;
    done += 1;
    const { iterations } = JSON.parse(fs.readFileSync(path.join(dir, "job.json"))).budget;
    if (wish.extended) assert.equal(iterations, larger(wish.kind).iterations, "it was extended");
    sameBits(dir, wholes[wish.kind][iterations]);
    assert.deepEqual(fs.readdirSync(dir).filter((n) => n === "checkpoint.unusable"), []);
  }
  const hidden = fs.readdirSync(path.join(places.data, "jobs")).filter((n) => n.startsWith("."));
  assert.deepEqual(hidden, [], "no folder is left half-made");
  assert.ok(done > 0 && kills > 0);
  t.diagnostic(`${wishes.length} jobs, ${done} done, ${wishes.length - done} cancelled; `
    + `the service was killed ${kills} times`);
});

test(`\`lacuna sweep\` and its renderers killed ${rounds} times`, async (t) => {
  const places = { ...folders(t), scenes };
  const wholes = references(places);
  const file = path.join(places.root, "a.json");
  fs.writeFileSync(file, JSON.stringify(kindsSweep));
  const runs = path.join(places.root, "a.sweep/runs");
  let kills = 0, sweeps = 0;
  while (kills < rounds) {
    fs.rmSync(path.dirname(runs), { recursive: true, force: true });
    for (let code = null; code !== 0;) {
      const child = spawn(lacuna, ["sweep", file, "-j", "2", "-q"], { env: environment(places), cwd: places.root });
      const ended = new Promise((resolve) => { child.on("close", resolve); });
      if (kills < rounds) {
        await pause(random(10) < 3 ? random(30) : random(900));
        if (child.exitCode === null) {
          kill({ child });
          kills += 1;
        }
      }
      code = await ended;
      assert.ok(code === null || code === 0, `exit code ${code}`);
    }
    sweeps += 1;
    assert.equal(fs.readdirSync(runs).length, 3 * kinds);
    for (const name of fs.readdirSync(runs)) {
      const folder = path.join(runs, name);
      assert.equal(checkFolder(folder), "done");
      const kind = (Number(name.slice(0, 4)) - 1) % kinds;
      sameBits(folder, wholes[kind][spec(kind).budget.iterations]);
    }
  }
  t.diagnostic(`${sweeps} sweeps of ${3 * kinds} runs, ${kills} kills`);
});

test("a disk that fills up, and one that turns read-only, cost no job", async (t) => {
  let unmount = () => {};
  t.after(() => unmount());
  const base = folders(t);
  // One of the database, and one of the jobs' folders.
  const disks = [base.data, path.join(base.data, "jobs")];
  const mounted = process.getuid() === 0 && disks.every((disk) => {
    fs.mkdirSync(disk, { recursive: true });
    return spawnSync("mount", ["-t", "tmpfs", "-o", "size=64m", "tmpfs", disk]).status === 0;
  });
  if (!mounted) return t.skip("a small disk can be mounted by root only");
  unmount = () => disks.reverse().forEach((disk) => spawnSync("umount", ["-l", disk]));
  const places = { ...base, scenes };
  const whole = references(base)[0][spec(0).budget.iterations];
  const service = await Service.start(places, [...options, "--disk-floor", "4M", "--jobs", "1"]);
  const wishes = Array.from({ length: 20 }, (_, i) => ({ key: `disk-${i}`, kind: 0 }));
  await postAll(service, wishes.slice(0, 3));
  const ballasts = disks.map((disk) => path.join(disk, "ballast"));
  for (const ballast of ballasts) {
    fs.writeFileSync(ballast, "");
    spawnSync("dd", ["if=/dev/zero", `of=${ballast}`, "bs=4096"]);  // until it is full
  }
  // The log of the database may have some room of its own.
  const answers = [];
  for (const wish of wishes.slice(3)) answers.push((await post(service, wish)).status);
  assert.ok(answers.every((status) => [201, 507].includes(status)), String(answers));
  assert.ok(answers.includes(507), "some do not fit");
  assert.equal((await service.json("/api/jobs")).total, 3 + answers.filter((status) => status === 201).length);
  assert.ok(await ask(service, "/health"), "it still answers");
  await pause(2000);
  for (const ballast of ballasts) fs.rmSync(ballast);
  await postAll(service, wishes);
  for (const wish of wishes) await service.reaches(wish.id, "done");

  assert.equal(spawnSync("mount", ["-o", "remount,ro", disks[1]]).status, 0);
  const sealed = { key: "sealed", kind: 0 };
  await postAll(service, [sealed]);
  await until(async () => /Read-only/.test((await service.json(`/api/jobs/${sealed.id}`)).state.obstacle), "it waits");
  assert.equal((await service.json(`/api/jobs/${wishes[0].id}`)).state.state, "done");
  assert.equal(spawnSync("mount", ["-o", "remount,rw", disks[1]]).status, 0);
  const last = { key: "last", kind: 0 };
  await postAll(service, [last]);
  await service.reaches(last.id, "done");
  await service.reaches(sealed.id, "done", 60000);
  for (const wish of [...wishes, sealed, last]) sameBits(service.folder(wish.id), whole);
  assert.equal((await service.json("/api/jobs")).total, wishes.length + 2, "none is lost or doubled");
  await service.stop();
});
