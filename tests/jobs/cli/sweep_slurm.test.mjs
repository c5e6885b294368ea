// `lacuna sweep --executor slurm`, by a stand-in of Slurm's programs: crashes, and what goes wrong.

import assert from "node:assert/strict";
import { existsSync, readFileSync, rmSync, symlinkSync, unlinkSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { until } from "../../server/service.mjs";
import { Cluster } from "../../server/slurm_cluster.mjs";
import { run, startWith, temporaryFolder } from "./command.mjs";

const small = {
  alone: false, seeds: 2, job: { scene: "cornell.glb", resolution: [16, 16], threads: 1, budget: { iterations: 2 } },
  axes: { "/integrator/max_depth": [2, 3, 4] },
};

/// A test with a sweep file a.json and a cluster; what still runs in it ends with it.
function onCluster(name, body) {
  test(name, async (t) => {
    const folder = temporaryFolder(t);
    writeFileSync(join(folder, "a.json"), JSON.stringify(small));
    const cluster = new Cluster(folder);
    try {
      await body(cluster, folder, t);
    } finally {
      await cluster.end();
    }
  });
}

const begin = (cluster, folder, ...more) => startWith(["env", ...cluster.environment], folder, "sweep", "a.json",
  "--executor", "slurm", "--slurm-poll", "0.1", ...more);
const sweep = (...all) => begin(...all).ended;
const record = (folder, name) => join(folder, `a.sweep/runs/${name}/slurm.json`);
const missing = async (folder) => (await run(folder, "sweep", "a.json", "--missing")).out;
const attempts = (folder, name) => JSON.parse(readFileSync(join(folder, `a.sweep/runs/${name}/outcome.json`))).attempts;
const names = ["0001-1", "0001-2", "0002-1", "0002-2", "0003-1", "0003-2"];

onCluster("sweep on Slurm: every run is a job of its own, done once", async (cluster, folder) => {
  const done = await sweep(cluster, folder, "--chunk", "4", "--jobs", "3", "--slurm-args", "--partition=long");
  assert.equal(done.code, 0, done.err);
  assert.match(done.err, /^warning: --chunk has no effect/m);
  assert.match(done.err, /^6 runs go to Slurm, at most 3 at a time$/m);
  const jobs = cluster.jobs();
  assert.equal(jobs.length, 6);
  for (const { name, options } of jobs) {
    assert.match(name, /^lacuna-000\d-\d-[0-9a-z]{8}$/);
    const { partition, signal, requeue } = options;
    assert.deepEqual({ partition, signal, requeue, cores: options["cpus-per-task"] },
      { partition: "long", signal: "B:TERM@30", requeue: true, cores: "1" });
  }
  assert.match(done.err, /^\[6\/6\] 000\d-\d max_depth \d: done$/m);
  assert.equal(await missing(folder), "\n");
  for (const each of names) {
    assert.equal(attempts(folder, each), 1, each);
    assert.equal(existsSync(record(folder, each)), false, "the submission is forgotten");
  }
  assert.equal(readFileSync(join(folder, "a.sweep/table.csv"), "utf8").trimEnd().split("\n").length > 6, true);
  assert.equal((await sweep(cluster, folder)).code, 0, "and nothing is left");
  assert.equal(cluster.calls("sbatch").length, 6);
});

onCluster("sweep on Slurm: it has so many runs at a time", async (cluster, folder) => {
  cluster.set("full");
  const going = begin(cluster, folder, "--jobs", "2");
  await until(() => cluster.jobs().length === 2, "two are submitted");
  const polls = cluster.calls("squeue").length;
  await until(() => cluster.calls("squeue").length >= polls + 3, "the queue looks at Slurm three times more");
  assert.equal(cluster.jobs().length, 2);
  cluster.unset("full");
  cluster.startWaiting();
  assert.equal((await going.ended).code, 0);
});

for (const [when, flag] of [["before sbatch has reached Slurm", "deaf"], ["before its answer is written down", "mute"]]) {
  onCluster(`sweep on Slurm: a command that is killed ${when} submits nothing twice`, async (cluster, folder) => {
    cluster.set(flag);
    const first = begin(cluster, folder, "--jobs", "1");
    await until(() => cluster.calls("sbatch").length === 1, "sbatch is called");
    assert.ok(existsSync(record(folder, names[0])), "it was written down before");
    // This cluster starts a job in sbatch's own process, which is about to end.
    if (flag === "mute") await until(() => ["RUNNING", "COMPLETED"].includes(cluster.jobs()[0]?.state), "Slurm has it");
    first.child.kill("SIGKILL");
    await first.ended;
    cluster.unset(flag);
    const second = await sweep(cluster, folder);
    assert.equal(second.code, 0, second.err);
    // sbatch ends with the command that called it: what had not reached Slurm is submitted again.
    assert.equal(cluster.calls("sbatch").length, flag === "deaf" ? 7 : 6);
    assert.equal(cluster.jobs().length, 6);
    for (const each of names) assert.equal(attempts(folder, each), 1, each);
  });
}

onCluster("sweep on Slurm: an interrupted command leaves its jobs, and the next follows them", async (cluster, folder) => {
  cluster.set("full");
  const first = begin(cluster, folder);
  await until(() => names.every((each) => existsSync(record(folder, each))
    && JSON.parse(readFileSync(record(folder, each))).job > 0), "all are submitted");
  const local = await run(folder, "sweep", "a.json");
  assert.equal(local.code, 2);
  assert.match(local.err, /0001-1 is submitted to Slurm as job \d; allowed: to continue with --executor slurm/);
  first.child.kill("SIGTERM");
  const { code, err } = await first.ended;
  assert.equal(code, 75);
  assert.match(err, /^interrupted; submitted runs continue in Slurm/m);
  cluster.unset("full");
  cluster.startWaiting();
  const second = await sweep(cluster, folder);
  assert.equal(second.code, 0, second.err);
  assert.equal(cluster.calls("sbatch").length, 6);
});

onCluster("sweep on Slurm: a run whose node is lost is submitted again", async (cluster, folder) => {
  cluster.set("full");
  const going = begin(cluster, folder);
  await until(() => cluster.jobs().length === 6, "all are submitted");
  cluster.change(cluster.jobs()[3].id, { state: "NODE_FAIL" });
  cluster.unset("full");
  cluster.startWaiting();
  const { code, err } = await going.ended;
  assert.equal(code, 0, err);
  assert.equal(cluster.calls("sbatch").length, 7);
  for (const each of names) assert.equal(attempts(folder, each), 1, each);
});

onCluster("sweep on Slurm: what scancel has ended failed, and the next command begins it anew", async (cluster, folder) => {
  cluster.set("full");
  const going = begin(cluster, folder);
  await until(() => cluster.jobs().length === 6, "it is submitted");
  for (const job of cluster.jobs()) cluster.change(job.id, { state: "CANCELLED" });
  const { code, err } = await going.ended;
  assert.equal(code, 1, err);
  assert.match(err, /0003-2 max_depth 4: failed: it was cancelled in Slurm; Slurm job \d: CANCELLED/);
  cluster.unset("full");
  assert.equal((await sweep(cluster, folder)).code, 0);
  for (const each of names) assert.equal(attempts(folder, each), 1, each);
});

onCluster("sweep on Slurm: what brings nothing is not submitted for ever", async (cluster, folder) => {
  writeFileSync(join(folder, "a.json"), JSON.stringify({ ...small, seeds: 1, axes: { "/scene": ["cornell.glb", "nowhere.glb"] } }));
  const { code, err } = await sweep(cluster, folder);
  assert.equal(code, 1, err);
  assert.match(err, /0002-1 scene nowhere\.glb: failed: .*nowhere\.glb/);
  assert.equal(cluster.calls("sbatch").length, 2, "what failed is over");
  cluster.set("full");
  const again = begin(cluster, folder);
  for (const round of [1, 2, 3]) {
    await until(() => cluster.calls("sbatch").length === 2 + round, `submission ${round}`);
    await until(() => cluster.jobs().some((job) => job.state === "PENDING"), "it waits");
    for (const job of cluster.jobs()) if (job.state === "PENDING") cluster.change(job.id, { state: "BOOT_FAIL" });
  }
  const end = await again.ended;
  assert.equal(end.code, 1);
  assert.match(end.err, /0002-1 scene nowhere\.glb: failed: .*BOOT_FAIL.*3 times/);
  assert.equal(cluster.calls("sbatch").length, 5);
});

onCluster("sweep on Slurm: refusals are told in Slurm's words, and its own options are refused", async (cluster, folder) => {
  const { child, ended } = begin(cluster, folder, "--slurm-args", "--partition=nowhere");
  await new Promise((seen) => {
    child.stderr.on("data", (bytes) => /jobs wait: .*invalid partition specified: nowhere/.test(bytes) && seen());
    ended.then(seen);
  });
  child.kill("SIGTERM");
  const refused = await ended;
  assert.equal(refused.code, 75, refused.err);
  assert.match(refused.err, /jobs wait: .*invalid partition specified: nowhere/);
  const own = await sweep(cluster, folder, "--slurm-args", "--array=1-3");
  assert.equal(own.code, 2);
  assert.match(own.err, /found "--array=1-3"/);
  const local = await run(folder, "sweep", "a.json", "--chunk", "2");
  assert.equal(local.code, 2);
  assert.match(local.err, /--chunk: needs --executor slurm/);
  for (const bad of ["0", "2-1", "x", "1,,2", "1-"]) {
    const { code, err } = await run(folder, "sweep", "a.json", "--index", bad);
    assert.equal(code, 2, bad);
    assert.match(err, /allowed: indices and ranges of them, such as 1,4-7/);
  }
  unlinkSync(join(folder, "bin/squeue"));
  rmSync(join(folder, "bin/sacct"));
  symlinkSync("/nowhere", join(folder, "bin/squeue"));
  const without = await startWith(["env", `PATH=${join(folder, "bin")}`], folder, "sweep", "a.json", "--executor", "slurm").ended;
  assert.equal(without.code, 1, without.err);
  assert.match(without.err, /--executor slurm needs Slurm's program squeue, which is not in PATH/);
});
