// The queue: order, cancelling, crashes, restarts.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { test } from "node:test";
import { folders, runToEnd, Service, until } from "./service.mjs";

const outcome = (service, id) =>
  JSON.parse(fs.readFileSync(path.join(service.folder(id), "outcome.json")));

/// The one child process of any thread of `pid`.
function rendererOf(pid) {
  const children = fs.readdirSync(`/proc/${pid}/task`).flatMap((task) =>
    fs.readFileSync(`/proc/${pid}/task/${task}/children`, "utf8").split(" ").filter(Boolean));
  assert.equal(children.length, 1);
  return Number(children[0]);
}

/// Whether a process runs; one that has ended may still be listed.
function runs(pid) {
  try {
    return !/^State:\s*Z/m.test(fs.readFileSync(`/proc/${pid}/status`, "utf8"));
  } catch {
    return false;
  }
}

test("jobs are rendered in their order, as many at a time as is allowed", async (t) => {
  const service = await Service.start(folders(t), ["--jobs", "2"]);
  const ids = [];
  for (const name of ["a", "b", "c", "d"]) ids.push(await service.post(`gate ${name}`));
  await service.reaches(ids[0], "running");
  await service.reaches(ids[1], "running");
  const states = async () => Promise.all(
    ids.map(async (id) => (await service.json(`/api/jobs/${id}`)).state.state));
  assert.deepEqual(await states(), ["running", "running", "queued", "queued"]);
  service.open("b");
  await service.reaches(ids[1], "done");
  await service.reaches(ids[2], "running");
  assert.deepEqual(await states(), ["running", "done", "running", "queued"]);
  for (const name of ["a", "c", "d"]) service.open(name);
  for (const id of ids) await service.reaches(id, "done");
});

test("a queued job is cancelled at once", async (t) => {
  const service = await Service.start(folders(t));
  const first = await service.post("gate one");
  await service.reaches(first, "running");
  const second = await service.post("finish");
  const third = await service.post("finish");
  const answer = await service.cancel(second);
  assert.equal(answer.status, 200);
  assert.equal((await answer.json()).state.state, "cancelled");
  assert.equal((await service.cancel(second)).status, 200, "again: still cancelled");
  service.open("one");
  await service.reaches(third, "done");
  const job = await service.json(`/api/jobs/${second}`);
  assert.equal(job.state.state, "cancelled");
  assert.equal(job.state.attempts, 0, "it was never started");
  assert.ok(job.state.finished);
  assert.equal((await service.cancel(third)).status, 409, "done is done");
});

test("a running job is asked to stop, and keeps its checkpoint", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("gate never");
  await service.reaches(id, "running");
  const answer = await service.cancel(id);
  assert.equal(answer.status, 202);
  assert.ok(["cancelling", "cancelled"].includes((await answer.json()).state.state));
  const job = await service.reaches(id, "cancelled");
  assert.equal(job.state.exit_code, 75);
  assert.ok(fs.existsSync(path.join(service.folder(id), "checkpoint.bin")));
});

test("a renderer that does not stop is killed after the grace", async (t) => {
  const service = await Service.start(folders(t), ["--grace", "0.2"]);
  const id = await service.post("stubborn");
  await service.reaches(id, "running");
  const asked = Date.now();
  assert.equal((await (await service.cancel(id)).json()).state.state, "cancelling");
  const job = await service.reaches(id, "cancelled");
  assert.ok(Date.now() - asked >= 200, "not before the grace has passed");
  assert.equal(job.state.exit_code, 128 + 9);
});

test("a crash is retried from the checkpoint", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("crash once");
  const job = await service.reaches(id, "done");
  assert.equal(job.state.attempts, 2);
  const log = await (await service.fetch(`/api/jobs/${id}/files/log.txt`)).text();
  assert.equal(log, "attempt 1\nattempt 2, resumed\n");
});

test("a job that crashes each time fails, with the reason, and the next one runs", async (t) => {
  const service = await Service.start(folders(t), ["--max-attempts", "2"]);
  const ids = [await service.post("crash"), await service.post("exit 1"), await service.post("exit 0")];
  const last = await service.post("finish");
  await service.reaches(last, "done");
  const states = [];
  for (const id of ids) states.push((await service.reaches(id, "failed")).state);
  assert.match(states[0].error, /signal 9 \(Killed\), 2 times/);
  assert.match(states[1].error, /exit code 1, 2 times/);
  assert.match(states[2].error, /exit code 0 but left no result/);
  for (const state of states) assert.equal(state.attempts, 2);
});

test("what the renderer refuses is not tried again", async (t) => {
  const service = await Service.start(folders(t));
  const said = await service.reaches(await service.post("fail"), "failed");
  assert.equal(said.state.error, "the scene is not to my liking");
  const silent = await service.reaches(await service.post("exit 3"), "failed");
  assert.match(silent.state.error, /exit code 3/);
  for (const job of [said, silent]) {
    assert.equal(job.state.attempts, 1);
    assert.equal(job.state.exit_code, 3);
  }
});

test("an interrupted renderer's job goes on: that is no crash", async (t) => {
  const service = await Service.start(folders(t), ["--max-attempts", "1"]);
  const id = await service.post("gate later");
  await service.reaches(id, "running");
  const report = path.join(service.folder(id), "log.txt");
  await until(() => fs.readFileSync(report, "utf8").includes("attempt 1"), "it began");
  process.kill(rendererOf(service.child.pid), "SIGTERM");
  await until(() => fs.readFileSync(report, "utf8").includes("attempt 2, resumed"), "it goes on");
  service.open("later");
  const job = await service.reaches(id, "done");
  assert.equal(job.state.attempts, 2);
});

test("an interruption that nobody asked for is a crash unless the job came on", async (t) => {
  const service = await Service.start(folders(t), ["--max-attempts", "2"]);
  const idle = await service.reaches(await service.post("interrupt"), "failed");
  assert.match(idle.state.error, /exit code 75, without a request or progress, 2 times/);
  assert.equal(idle.state.attempts, 3, "the first brought it from nothing to iteration 25");
  const busy = await service.reaches(await service.post("interrupt on"), "done");
  assert.equal(busy.state.attempts, 4);
});

test("a renderer that ran out of memory is named, and tried again like one that crashed", async (t) => {
  const service = await Service.start(folders(t), ["--max-attempts", "3", "--memory-limit", "4G"]);
  const { state } = await service.reaches(await service.post("memory"), "failed");
  assert.equal(state.error, "renderer ran out of memory (limit 4.0 GiB), 3 times");
  assert.deepEqual([state.attempts, state.exit_code], [3, 71]);
});

/// A control group of a test's own with so much memory; nothing where none can be made.
function memoryGroup(t, bytes) {
  const places = [["/sys/fs/cgroup/memory", "memory.limit_in_bytes"], ["/sys/fs/cgroup", "memory.max"]];
  for (const [root, limit] of places) {
    const group = path.join(root, `lacuna-test-${process.pid}`);
    try {
      fs.mkdirSync(group);
      t.after(() => until(() => {
        try {
          fs.rmdirSync(group);
          return true;
        } catch {
          return false;  // its processes are still ending
        }
      }, "the control group is empty"));
      fs.writeFileSync(path.join(group, limit), String(bytes), { flag: "r+" });
      return group;
    } catch {
      // the other kind, perhaps
    }
  }
  return null;
}

test("short of memory, the kernel takes the renderer, and the service names it", async (t) => {
  const places = folders(t);
  // The kernel may need a second process before the memory of the one that it has killed is free. It shall have
  // these, not the service.
  const others = [1, 2, 3].map(() => spawn("sleep", ["600"]));
  t.after(() => others.forEach((other) => other.kill()));
  const group = memoryGroup(t, 256 << 20);
  if (!group) return t.skip("a control group can be made by root only");
  const service = await Service.start(places, ["--max-attempts", "2"]);
  for (const { pid } of others) fs.writeFileSync(`/proc/${pid}/oom_score_adj`, "400");
  for (const { pid } of [service.child, ...others]) fs.writeFileSync(path.join(group, "cgroup.procs"), String(pid));
  const { state } = await service.reaches(await service.post("hog"), "failed");
  assert.equal(state.error, "renderer ran out of memory: killed by the kernel, 2 times");
  assert.deepEqual([state.attempts, state.exit_code], [2, 128 + 9]);
  await service.reaches(await service.post("finish"), "done");
  return undefined;
});

test("renderers are held to their limits and stand back", async (t) => {
  const limits = async (...args) => {
    const service = await Service.start(folders(t), args);
    const id = await service.post("limits");
    await service.reaches(id, "done");
    return service.json(`/api/jobs/${id}/files/report.json`);
  };
  const own = { nice: os.getPriority(), score: Number(fs.readFileSync("/proc/self/oom_score_adj", "utf8")) };
  const preset = await limits();
  assert.equal(preset.nice, Math.min(19, own.nice + 10));
  assert.equal(preset.oom_score_adj, Math.min(1000, own.score + 500));
  assert.equal(preset.data, "unlimited");
  const given = await limits("--nice", "0", "--memory-limit", "3G");
  assert.equal(given.nice, own.nice);
  assert.equal(given.data, String(3 * 1024 ** 3));
});

test("a renderer gets the folders, and nothing else that is open", async (t) => {
  const places = folders(t);
  const service = await Service.start(places);
  const watched = await service.post("gate watched");
  await service.reaches(watched, "running");
  const stream = await service.fetch(`/api/jobs/${watched}/events`);
  const renderer = rendererOf(service.child.pid);
  const sockets = fs.readdirSync(`/proc/${renderer}/fd`).filter((fd) => {
    try {
      return fs.readlinkSync(`/proc/${renderer}/fd/${fd}`).startsWith("socket:");
    } catch {
      return false;
    }
  });
  assert.deepEqual(sockets, [], "no connection of the service");
  service.open("watched");
  await stream.text();

  const id = await service.post("environment");
  await service.reaches(id, "done");
  const seen = await service.json(`/api/jobs/${id}/files/report.json`);
  assert.equal(seen.directory, places.data);
  assert.equal(seen.cache, path.join(places.data, "cache"));
  assert.equal(seen.data, places.data);
  assert.equal(seen.scenes, places.scenes);
});

test("a renderer starts with no signal blocked or ignored", async (t) => {
  const places = folders(t);
  const renderer = path.join(places.root, "renderer");
  // Perl, because shells and Node unblock all signals by themselves.
  fs.writeFileSync(renderer, `#!/usr/bin/perl
    open(IN, "</proc/self/status"); open(OUT, ">$ARGV[1]/curve.csv"); print OUT <IN>; close OUT; exit 3;
  `, { mode: 0o755 });
  const service = await Service.start(places, ["--renderer", renderer]);
  const id = await service.post("finish");
  await service.reaches(id, "failed");
  const status = await (await service.fetch(`/api/jobs/${id}/files/curve.csv`)).text();
  const mask = (name) => BigInt(`0x${new RegExp(`^${name}:\\s*(\\w+)`, "m").exec(status)[1]}`);
  const watched = [1, 2, 13, 15].reduce((sum, signal) => sum | (1n << BigInt(signal - 1)), 0n);
  assert.equal(mask("SigBlk"), 0n);
  assert.equal(mask("SigIgn") & watched, 0n);
});

test("ended gently, the service lets renderers save, and goes on after a restart", async (t) => {
  const places = folders(t);
  const first = await Service.start(places);
  const running = await first.post("gate go");
  await first.reaches(running, "running");
  const waiting = await first.post("gate go");
  const gone = await first.post("finish");
  await first.cancel(gone);
  assert.deepEqual(await first.stop(), { code: 0, signal: null });
  assert.equal(first.stored(running).state, "queued");
  assert.equal(first.stored(running).finished, "");
  assert.equal(first.stored(waiting).state, "queued");
  assert.ok(fs.existsSync(path.join(first.folder(running), "checkpoint.bin")));

  const second = await Service.start(places);
  await second.reaches(running, "running");
  assert.equal((await second.json(`/api/jobs/${waiting}`)).state.state, "queued", "same order");
  second.open("go");
  const done = await second.reaches(running, "done");
  assert.equal(done.state.attempts, 2);
  assert.ok((await second.json(`/api/jobs/${running}/files/report.json`)).resumed);
  await second.reaches(waiting, "done");
  assert.equal((await second.json(`/api/jobs/${gone}`)).state.state, "cancelled");
});

test("a renderer that has to be killed at the end of the service costs no job", async (t) => {
  const service = await Service.start(folders(t), ["--grace", "0.2", "--max-attempts", "1"]);
  const id = await service.post("stubborn");
  await service.reaches(id, "running");
  assert.deepEqual(await service.stop(), { code: 0, signal: null });
  const state = service.stored(id);
  assert.deepEqual([state.state, state.exit_code, state.error], ["queued", 128 + 9, ""]);
});

test("killed, the service takes its renderers along and loses no job", async (t) => {
  const places = folders(t);
  const first = await Service.start(places);
  const running = await first.post("gate go");
  await first.reaches(running, "running");
  const waiting = await first.post("gate go");
  const renderer = rendererOf(first.child.pid);
  await first.stop("SIGKILL");
  await until(() => !runs(renderer), "its renderer ends too");
  assert.equal(outcome(first, running).state, "interrupted");

  const second = await Service.start(places);
  second.open("go");
  assert.equal((await second.reaches(running, "done")).state.attempts, 2);
  await second.reaches(waiting, "done");
});

test("a folder that another renderer still holds is waited for", async (t) => {
  const places = folders(t);
  const first = await Service.start(places);
  const id = await first.post("gate x");
  await first.reaches(id, "running");
  await first.stop();
  const holder = spawn("flock", [path.join(first.folder(id), ".lock"), "cat"],
    { stdio: ["pipe", "pipe", "ignore"] });
  t.after(() => holder.kill("SIGKILL"));
  holder.stdin.write("held\n");
  await new Promise((resolve) => { holder.stdout.once("data", resolve); });

  const second = await Service.start(places);
  second.open("x");
  const other = await second.post("finish");
  await second.cancel(other);
  await second.reaches(other, "cancelled");
  assert.equal((await second.json(`/api/jobs/${id}`)).state.attempts, 1, "nothing is started yet");
  holder.stdin.end();
  assert.equal((await second.reaches(id, "done")).state.attempts, 2);
});

test("two services never share a data folder", async (t) => {
  const places = folders(t);
  const service = await Service.start(places);
  const { code, err } = await runToEnd(["--port", "0", "--data", places.data, "--scenes", places.scenes,
    "--renderer", "/bin/true"]);
  assert.equal(code, 1);
  assert.match(err, /another lacuna-server/);
  assert.deepEqual(await service.json("/health"), { status: "ok" });
});
