// `lacuna sweep --executor slurm`, by a stand-in of Slurm's programs: an array of chunks, crashes, what goes wrong.

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
const record = (folder) => join(folder, "a.sweep/slurm.json");
const missing = async (folder) => (await run(folder, "sweep", "a.json", "--missing")).out;
const attempts = (folder, name) => JSON.parse(readFileSync(join(folder, `a.sweep/runs/${name}/outcome.json`))).attempts;
const names = ["0001-1", "0001-2", "0002-1", "0002-2", "0003-1", "0003-2"];

onCluster("sweep on Slurm: an array of chunks does every run once", async (cluster, folder) => {
  const done = await sweep(cluster, folder, "--chunk", "4", "--jobs", "3", "--slurm-args", "--partition=long");
  assert.equal(done.code, 0, done.err);
  const [{ options, name }, ...others] = cluster.jobs();
  assert.equal(others.length, 1, "two tasks");
  assert.match(name, /^lacuna-a\.sweep-[0-9a-z]{8}$/);
  const { array, partition, signal, requeue } = options;
  assert.deepEqual({ array, partition, signal, requeue, cores: options["cpus-per-task"] },
    { array: "1-2%3", partition: "long", signal: "B:TERM@30", requeue: true, cores: "1" });
  assert.match(readFileSync(cluster.jobs()[0].copy, "utf8"), /^1-4\n5-6\n/m);
  assert.match(done.err, /^6 runs are submitted as Slurm job 1, 2 tasks$/m);
  assert.match(done.err, /^\[6\/6\] 000\d-\d max_depth \d: done$/m);
  assert.equal(await missing(folder), "\n");
  for (const each of names) assert.equal(attempts(folder, each), 1, each);
  assert.equal(existsSync(record(folder)), false, "the submission is forgotten");
  assert.equal(readFileSync(join(folder, "a.sweep/table.csv"), "utf8").trimEnd().split("\n").length > 6, true);
  assert.equal((await sweep(cluster, folder)).code, 0, "and nothing is left");
  assert.equal(cluster.calls("sbatch").length, 1);
});

for (const [when, flag] of [["before sbatch has reached Slurm", "deaf"], ["before its answer is written down", "mute"]]) {
  onCluster(`sweep on Slurm: a command that is killed ${when} submits nothing twice`, async (cluster, folder) => {
    cluster.set(flag);
    const first = begin(cluster, folder);
    await until(() => cluster.calls("sbatch").length === 1, "sbatch is called");
    assert.ok(existsSync(record(folder)), "it was written down before");
    if (flag === "mute") await until(() => cluster.jobs().length === 6, "Slurm has it");
    first.child.kill("SIGKILL");
    await first.ended;
    cluster.unset(flag);
    // A person would wait for the answer that is under way: whoever asks too early submits anew, and the late
    // submission does nothing.
    if (flag === "deaf") await until(() => cluster.jobs().length === 6, "Slurm has it");
    const second = await sweep(cluster, folder);
    assert.equal(second.code, 0, second.err);
    assert.match(second.err, /^an earlier submission is looked up by its name$/m);
    assert.equal(cluster.calls("sbatch").length, 1);
    for (const each of names) assert.equal(attempts(folder, each), 1, each);
  });
}

onCluster("sweep on Slurm: an interrupted command leaves the array, and the next follows it", async (cluster, folder) => {
  cluster.set("full");
  const first = begin(cluster, folder);
  await until(() => existsSync(record(folder)) && JSON.parse(readFileSync(record(folder))).job === 1, "it is submitted");
  const other = await sweep(cluster, folder);
  assert.equal(other.code, 2);
  assert.match(other.err, /another process submits and follows the runs/);
  const local = await run(folder, "sweep", "a.json");
  assert.equal(local.code, 2);
  assert.match(local.err, /its runs are submitted to Slurm as job 1; allowed: to go on with --executor slurm/);
  first.child.kill("SIGTERM");
  const { code, err } = await first.ended;
  assert.equal(code, 75);
  assert.match(err, /^interrupted; job 1 goes on in Slurm/m);
  cluster.unset("full");
  cluster.startWaiting();
  const second = await sweep(cluster, folder);
  assert.equal(second.code, 0, second.err);
  assert.equal(cluster.calls("sbatch").length, 1);
});

onCluster("sweep on Slurm: what a lost task leaves undone is submitted again", async (cluster, folder) => {
  writeFileSync(join(cluster.folder, "full"), "2");
  const going = begin(cluster, folder, "--chunk", "2");
  await until(async () => await missing(folder) === "5-6\n", "two tasks of three are done");
  cluster.change(3, { state: "NODE_FAIL" });
  cluster.unset("full");
  const { code, err } = await going.ended;
  assert.equal(code, 0, err);
  assert.match(err, /Slurm job 1 left 2 runs undone: .*1 NODE_FAIL; they are submitted again/);
  assert.match(err, /^2 runs are submitted as Slurm job 4, 1 tasks$/m);
  for (const each of names) assert.equal(attempts(folder, each), 1, each);
});

onCluster("sweep on Slurm: scancel ends the command, and the next begins anew", async (cluster, folder) => {
  cluster.set("full");
  const going = begin(cluster, folder);
  await until(() => cluster.jobs().length === 6, "it is submitted");
  for (const job of cluster.jobs()) cluster.change(job.id, { state: "CANCELLED" });
  const { code, err } = await going.ended;
  assert.equal(code, 1, err);
  assert.match(err, /left 6 runs undone: 6 CANCELLED; the same command submits them again/);
  cluster.unset("full");
  assert.equal((await sweep(cluster, folder)).code, 0);
  for (const each of names) assert.equal(attempts(folder, each), 1, each);
});

onCluster("sweep on Slurm: tasks that bring nothing are not submitted for ever", async (cluster, folder) => {
  writeFileSync(join(folder, "a.json"), JSON.stringify({ ...small, axes: { "/scene": ["cornell.glb", "nowhere.glb"] } }));
  const { code, err } = await sweep(cluster, folder);
  assert.equal(code, 1, err);
  assert.match(err, /0002-1 scene nowhere\.glb: failed: .*nowhere\.glb/);
  assert.equal(cluster.calls("sbatch").length, 1, "what failed is over");
  cluster.set("full");
  const again = begin(cluster, folder);
  for (const round of [1, 2, 3]) {
    await until(() => cluster.calls("sbatch").length === 1 + round, `submission ${round}`);
    await until(() => cluster.jobs().some((job) => job.state === "PENDING"), "its tasks wait");
    for (const job of cluster.jobs()) if (job.state === "PENDING") cluster.change(job.id, { state: "BOOT_FAIL" });
  }
  const end = await again.ended;
  assert.equal(end.code, 1);
  assert.match(end.err, /3 submissions brought nothing: .*a\.sweep\/log\.txt tells more/);
  assert.equal(cluster.calls("sbatch").length, 4);
});

onCluster("sweep on Slurm: refusals are told in Slurm's words, and its own options are refused", async (cluster, folder) => {
  const refused = await sweep(cluster, folder, "--slurm-args", "--partition=nowhere");
  assert.equal(refused.code, 1, refused.err);
  assert.match(refused.err, /invalid partition specified: nowhere/);
  assert.equal(existsSync(record(folder)), false);
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
