// Jobs through Slurm, by a stand-in of its programs: submissions, states, requests, crashes of the service.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { folders, runToEnd, Service, until } from "./service.mjs";
import { Cluster } from "./slurm_cluster.mjs";

const poll = 0.1;

class ServedCluster extends Cluster {
  constructor(places) {
    super(places.root);
    this.places = places;
  }

  service(...options) {
    return Service.start(this.places, ["--executor", "slurm", "--slurm-poll", String(poll), ...options],
      ["env", ...this.environment]);
  }
}

/// A test with a cluster; what still runs in it ends with it.
function onCluster(name, body) {
  test(name, async (t) => {
    const cluster = new ServedCluster(folders(t));
    try {
      await body(cluster, t);
    } finally {
      await Promise.all(cluster.places.services.map((service) => service.stop("SIGKILL")));
      await cluster.end();
    }
  });
}

const recordOf = (service, id) => path.join(service.folder(id), "slurm.json");
const submitted = (cluster, count) => until(() => cluster.jobs().length === count, `${count} submissions`);
const running = (cluster, number) => until(() => cluster.jobs()[number - 1]?.state === "RUNNING", `${number} runs`);
const state = async (service, id) => (await service.json(`/api/jobs/${id}`)).state;

onCluster("a job asks Slurm for what it needs, is submitted once, and is done", async (cluster) => {
  const service = await cluster.service("--grace", "4", "--slurm-args", "--partition=long --account=me");
  const id = await service.post("gate go", { threads: 3, budget: { seconds: 100 }, resolution: [1000, 1000] });
  await service.reaches(id, "running");
  await until(async () => (await state(service, id)).place === "Slurm job 1 on node1", "its place is told");
  service.open("go");
  await service.reaches(id, "done");
  const [{ options, name }] = cluster.jobs();
  assert.match(name, new RegExp(`^lacuna-${id}-[0-9a-z]{8}$`));
  const { time, mem, nice, signal, requeue, partition, account } = options;
  assert.deepEqual({ time, nice, signal, requeue, partition, account, cores: options["cpus-per-task"] },
    { time: "18", nice: "100", signal: "B:TERM@4", requeue: true, partition: "long", account: "me", cores: "3" });
  assert.equal(mem, "1406M");  // 1 GiB, and 400 bytes for each pixel
  assert.equal(options.exclusive, undefined);
  assert.equal(cluster.jobs().length, 1);
  await until(() => !fs.existsSync(recordOf(service, id)), "the submission is forgotten");
  assert.equal((await state(service, id)).place, "");
  assert.equal((await service.json("/api/info")).settings.executor, "slurm");
});

onCluster("a job without a number of threads, or alone, has a node of its own", async (cluster) => {
  const service = await cluster.service();
  const all = await service.post("environment");
  const alone = await service.post("finish", { threads: 1, exclusive: true });
  for (const id of [all, alone]) await service.reaches(id, "done");
  const options = Object.fromEntries(cluster.jobs().map((job) => [job.name.slice(7, 29), job.options]));
  assert.equal(options[all].exclusive, true);
  assert.equal(options[all]["cpus-per-task"], undefined);
  assert.equal(options[alone].exclusive, true);
  const seen = JSON.parse(fs.readFileSync(path.join(service.folder(all), "report.json")));
  assert.deepEqual([seen.threads, seen.data, seen.directory], ["2", cluster.places.data, cluster.places.data]);
});

onCluster("an answer of sbatch that is lost costs and doubles nothing", async (cluster) => {
  cluster.set("lose");
  const service = await cluster.service();
  const id = await service.post("finish", { threads: 1 });
  const job = await service.reaches(id, "done");
  assert.equal(job.state.attempts, 1);
  assert.equal(cluster.jobs().length, 1);
});

for (const [when, flag] of [["before sbatch has reached Slurm", "deaf"], ["before its answer is written down", "mute"]]) {
  onCluster(`a service that is killed ${when} submits no job twice`, async (cluster) => {
    cluster.set(flag);
    const first = await cluster.service();
    const id = await first.post("gate go", { threads: 1 });
    await until(() => cluster.calls("sbatch").length === 1, "sbatch is called");
    assert.ok(fs.existsSync(recordOf(first, id)), "it was written down before");
    if (flag === "mute") await running(cluster, 1);
    await first.stop("SIGKILL");
    cluster.unset(flag);
    const second = await cluster.service();
    await second.reaches(id, "running");
    second.open("go");
    const job = await second.reaches(id, "done");
    assert.equal(job.state.attempts, 1);
    assert.equal(cluster.jobs().length, 1);
    assert.equal(cluster.calls("sbatch").length, flag === "mute" ? 1 : 2);
  });
}

onCluster("a submission that nobody waits for any more renders nothing", async (cluster) => {
  cluster.set("full");
  const first = await cluster.service();
  const id = await first.post("finish", { threads: 1 });
  await submitted(cluster, 1);
  await first.stop("SIGKILL");
  cluster.change(1, { forgotten: true });  // and yet it will begin
  cluster.unset("full");
  const second = await cluster.service();
  await submitted(cluster, 2);
  const job = await second.reaches(id, "done");
  assert.equal(job.state.attempts, 1);
});

onCluster("renderers outlive the service, which finds them again", async (cluster) => {
  const first = await cluster.service("--jobs", "4");
  const ids = [];
  for (const name of ["a", "b", "c"]) ids.push(await first.post(`gate ${name}`, { threads: 1 }));
  for (const id of ids) await first.reaches(id, "running");
  await first.stop("SIGKILL");
  first.open("a");  // ends while there is no service
  // Which submission is the first one's depends on which sbatch was first.
  await until(() => cluster.jobs().some((job) => job.state === "COMPLETED"), "the first has ended");
  const second = await cluster.service("--jobs", "4");
  await until(async () => (await state(second, ids[0])).state === "done", "its folder says that it is done");
  await second.stop("SIGTERM");
  assert.deepEqual(cluster.jobs().map((job) => job.state).sort(), ["COMPLETED", "RUNNING", "RUNNING"]);
  const third = await cluster.service("--jobs", "1");  // fewer runners than submissions
  const late = await third.post("finish", { threads: 1, label: "finish" });
  third.open("b");
  third.open("c");
  for (const id of [ids[1], ids[2], late]) assert.equal((await third.reaches(id, "done")).state.attempts, 1);
  assert.equal(cluster.jobs().length, 4);
});

onCluster("waiting and running jobs are cancelled and held in Slurm", async (cluster) => {
  const service = await cluster.service("--grace", "1");
  const run = await service.post("gate never", { threads: 1 });
  await service.reaches(run, "running");
  await service.cancel(run);
  await service.reaches(run, "cancelled");
  assert.ok(fs.existsSync(path.join(service.folder(run), "checkpoint.bin")), "it was asked first");
  const stubborn = await service.post("stubborn", { threads: 1 });
  await service.reaches(stubborn, "running");
  await service.cancel(stubborn);
  await service.reaches(stubborn, "cancelled");
  cluster.set("full");
  const waits = await service.post("gate never", { threads: 1 });
  await until(async () => (await state(service, waits)).place === "Slurm job 3 waits: Resources", "it is seen to wait");
  const patch = (change) => service.fetch(`/api/jobs/${waits}`, { method: "PATCH", body: JSON.stringify(change),
    headers: { "Content-Type": "application/json" } });
  await patch({ priority: 7 });
  await until(() => cluster.jobs()[2].options.nice === "93", "its niceness follows");
  await patch({ held: true });
  await service.reaches(waits, "held");
  assert.equal(cluster.jobs()[2].state, "CANCELLED");
  await patch({ held: false });
  await submitted(cluster, 4);
  await service.cancel(waits);
  await service.reaches(waits, "cancelled");
  assert.deepEqual(cluster.jobs().map((job) => job.state), ["FAILED", "CANCELLED", "CANCELLED", "CANCELLED"]);
});

onCluster("a node that fails, a time limit and want of memory go on from the checkpoint", async (cluster) => {
  const service = await cluster.service("--max-attempts", "2");
  const lost = await service.post("gate go", { threads: 1 });
  await running(cluster, 1);
  await service.reaches(lost, "running");
  cluster.take(1, "NODE_FAIL");
  await running(cluster, 2);
  service.open("go");
  assert.equal((await service.reaches(lost, "done")).state.attempts, 2);

  const small = await service.post("gate big", { threads: 1 });
  await running(cluster, 3);
  await service.reaches(small, "running");
  cluster.take(3, "OUT_OF_MEMORY");
  await running(cluster, 4);
  const [before, after] = cluster.jobs().slice(2).map((job) => parseInt(job.options.mem, 10));
  assert.ok(Math.abs(after - 2 * before) <= 1, `${before} MB, then ${after}`);
  cluster.take(4, "TIMEOUT");
  const over = await service.reaches(small, "failed");
  assert.match(over.state.error, /^renderer|Slurm job 4: TIMEOUT/);
});

onCluster("a requeued job goes on as the same submission", async (cluster) => {
  const service = await cluster.service();
  const id = await service.post("gate go", { threads: 1 });
  await service.reaches(id, "running");
  await running(cluster, 1);
  cluster.take(1, "requeue", "SIGTERM");
  await until(async () => (await state(service, id)).place === "Slurm job 1 waits: BeginTime", "it waits again");
  cluster.startWaiting();
  service.open("go");
  const job = await service.reaches(id, "done");
  assert.equal(job.state.attempts, 2);
  assert.ok(JSON.parse(fs.readFileSync(path.join(service.folder(id), "report.json"))).resumed);
  assert.equal(cluster.jobs().length, 1);
});

onCluster("a job that a person cancels in Slurm is not submitted again", async (cluster) => {
  const service = await cluster.service();
  const id = await service.post("gate never", { threads: 1 });
  await service.reaches(id, "running");
  await running(cluster, 1);
  cluster.take(1, "CANCELLED", "SIGTERM");
  const over = await service.reaches(id, "failed");
  assert.equal(over.state.error, "it was cancelled in Slurm; Slurm job 1: CANCELLED");
  assert.equal(cluster.jobs().length, 1);
});

onCluster("what sbatch refuses is told in its own words", async (cluster) => {
  const service = await cluster.service("--slurm-args", "--partition=nowhere");
  const id = await service.post("finish", { threads: 1 });
  const refused = /sbatch: error: invalid partition specified: nowhere; .* Invalid partition name specified$/;
  await until(async () => refused.test((await state(service, id)).obstacle), "the job says why it waits");
  assert.equal((await state(service, id)).state, "queued");
  assert.match((await service.json("/health")).obstacle, refused);
  await service.stop();
  const other = await cluster.service("--memory-limit", "200G");
  const over = await other.reaches(id, "failed");
  assert.match(over.state.error, /sbatch: error: Memory specification can not be satisfied/);
});

onCluster("without rights a job waits and says so; with room in the quota again it goes on", async (cluster) => {
  const closed = await cluster.service("--slurm-args", "--partition=closed");
  const id = await closed.post("finish", { threads: 1 });
  const told = async (service, words) => until(async () => words.test((await state(service, id)).obstacle), `${words}`);
  await told(closed, /User's group not permitted to use this partition/);
  await closed.stop();
  cluster.set("quota");
  const service = await cluster.service();
  await told(service, /QOSMaxSubmitJobPerUserLimit; .*Job violates accounting\/QOS policy/);
  assert.equal((await state(service, id)).state, "queued");
  cluster.unset("quota");
  const job = await service.reaches(id, "done");
  assert.equal(job.state.attempts, 1);
  assert.equal(cluster.jobs().length, 1);
});

onCluster("a shared folder that lags is waited for", async (cluster) => {
  // The last --slurm-poll counts: five of these are ten seconds.
  const service = await cluster.service("--slurm-poll", "2");
  const id = await service.post("lag", { threads: 1 });
  const job = await service.reaches(id, "done");
  assert.equal(job.state.attempts, 1);
  assert.equal(cluster.jobs().length, 1);
});

onCluster("clocks of nodes may be days ahead or behind", async (cluster) => {
  const service = await cluster.service("--keep-days", "1");
  const names = ["clock 72", "clock -72", "finish"];
  const ids = [];
  for (const name of names) ids.push(await service.post(name, { threads: 1 }));
  for (const id of ids) await service.reaches(id, "done");
  await service.stop("SIGKILL");
  const again = await cluster.service("--keep-days", "1");
  for (const id of ids) {
    assert.equal((await state(again, id)).state, "done");
    assert.equal((await state(again, id)).attempts, 1);
  }
  const listed = (await again.json("/api/jobs")).jobs.map((job) => job.id);
  assert.deepEqual(listed, ids.toReversed(), "in the order in which they were posted");
  assert.equal(cluster.jobs().length, names.length);
});

onCluster("a controller that is away is waited for", async (cluster) => {
  const service = await cluster.service();
  const first = await service.post("gate go", { threads: 1 });
  await service.reaches(first, "running");
  cluster.set("down");
  const second = await service.post("finish", { threads: 1 });
  await until(async () => /Unable to contact slurm controller/.test((await service.json("/health")).obstacle ?? ""),
    "the service says so");
  service.open("go");  // its folder says that it is over
  await service.reaches(first, "done");
  cluster.unset("down");
  await service.reaches(second, "done");
  assert.equal(cluster.jobs().length, 2);
});

onCluster("squeue is called no oftener with many jobs", async (cluster) => {
  const began = Date.now();
  const service = await cluster.service("--jobs", "20", "--slurm-poll", "1");
  cluster.set("full");
  const ids = [];
  for (let n = 0; n < 20; n += 1) ids.push(await service.post("finish", { threads: 1 }));
  await submitted(cluster, 20);
  await until(() => cluster.calls("squeue").length >= 3, "it is called");
  const seconds = (Date.now() - began) / 1000;
  assert.ok(cluster.calls("squeue").length <= seconds + 2);
});

onCluster("without Slurm, and with options that Lacuna needs itself, the service does not start", async (cluster) => {
  const begin = (environment, ...options) => runToEnd(["--executor", "slurm", "--data", cluster.places.data,
    "--port", "0", ...options], { env: { ...process.env, ...environment } });
  const bare = await begin({ PATH: "/nowhere" });
  assert.equal(bare.code, 1);
  assert.match(bare.err, /--executor slurm needs Slurm's program sbatch, which is not in PATH/);
  const named = await begin({}, "--slurm-args", "--job-name=mine");
  assert.notEqual(named.code, 0);
  assert.match(named.err, /--slurm-args: found "--job-name=mine"/);
  const local = await runToEnd(["--slurm-cores", "2"]);
  assert.match(local.err, /--slurm-cores: needs --executor slurm/);
});
