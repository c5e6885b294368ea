// `lacuna sweep`: many jobs that differ in some settings, resumed, listed, and as array tasks.

import assert from "node:assert/strict";
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { until } from "../../server/service.mjs";
import { program, run, start, startWith, temporaryFolder } from "./command.mjs";

const small = {
  label: "small", seeds: 2, baseline: { "/integrator/max_depth": 2 },
  job: { scene: "ajar.glb", camera: "room", resolution: [24, 16], budget: { iterations: 4 } },
  axes: { "/integrator/max_depth": [2, 4], "/integrator/next_event_estimation": [true, false] },
};

function sweepFile(t, sweep = small) {
  const folder = temporaryFolder(t);
  writeFileSync(join(folder, "a.json"), JSON.stringify(sweep));
  return folder;
}

const rows = (folder) => readFileSync(join(folder, "a.sweep/table.csv"), "utf8").trimEnd().split("\n");

test("sweep: every run is a job's folder, and all curves are one table", async (t) => {
  const folder = sweepFile(t);
  const done = await run(folder, "sweep", "a.json");
  assert.equal(done.code, 0, done.err);
  assert.match(done.err, /^\[8\/8\] 0004-2 max_depth 4, next_event_estimation false: done$/m);
  const names = readdirSync(join(folder, "a.sweep/runs"));
  assert.deepEqual(names, [1, 2, 3, 4].flatMap((cell) => [`000${cell}-1`, `000${cell}-2`]));
  const job = JSON.parse(readFileSync(join(folder, "a.sweep/runs/0003-2/job.json"), "utf8"));
  assert.equal(job.seed, 2);
  assert.equal(job.integrator.max_depth, 4);
  assert.equal(job.label, "small: max_depth 4, next_event_estimation true");
  const [header, ...instants] = rows(folder);
  assert.match(header, /^run,cell,baseline,replicate,seed,state,\/integrator\/max_depth,\/integrator\/next_event_estimation,iteration,seconds,/);
  assert.ok(instants.some((line) => line.startsWith("0003-2,3,1,2,2,done,4,true,4,")), instants[0]);
  assert.ok(instants.some((line) => line.startsWith("0002-1,2,2,1,1,done,2,false,")));
  assert.equal((await run(folder, "sweep", "a.sweep", "--missing")).out, "\n");
});

test("sweep: settings that are objects stand flat in the table, too", async (t) => {
  const sweep = { job: { ...small.job, budget: { iterations: 1 } },
    axes: { "/integrator": [{ type: "path", guide: { type: "skeleton", strength: 4 } }, { type: "bdpt", max_depth: 3 }] } };
  const folder = sweepFile(t, sweep);
  assert.equal((await run(folder, "sweep", "a.json", "-q")).code, 0);
  const [header, first, second] = rows(folder);
  assert.match(header, /^run,cell,baseline,replicate,seed,state,\/integrator,\/integrator\.guide\.strength,\/integrator\.guide\.type,\/integrator\.max_depth,\/integrator\.type,iteration,/);
  assert.match(first, /^0001-1,1,,1,1,done,".*",4,skeleton,,path,1,/);
  assert.match(second, /^0002-1,2,,1,1,done,".*",,,3,bdpt,1,/);
  // As RFC 4180 has it: a quote within a field is doubled, and the field reads back as what was swept.
  const quoted = (line) => /^(?:[^,]*,){6}"((?:[^"]|"")*)",/.exec(line)[1].replaceAll('""', '"');
  assert.deepEqual([first, second].map((line) => JSON.parse(quoted(line))), sweep.axes["/integrator"]);
});

test("sweep: what is listed is not begun, and array tasks do one run each", async (t) => {
  const folder = sweepFile(t);
  const listed = await run(folder, "sweep", "a.json", "--list");
  assert.match(listed.out, /^ +8 0004-2 +queued +max_depth 4, next_event_estimation false$/m);
  assert.equal(existsSync(join(folder, "a.sweep")), false);
  for (const index of ["3", "8"]) assert.equal((await run(folder, "sweep", "a.json", "--index", index)).code, 0);
  assert.equal((await run(folder, "sweep", "a.json", "--missing")).out, "1-2,4-7\n");
  const beyond = await run(folder, "sweep", "a.json", "--index", "9");
  assert.equal(beyond.code, 2);
  assert.match(beyond.err, /--index 9: the sweep has runs 1 to 8/);
  assert.equal((await run(folder, "sweep", "a.sweep", "-j", "3", "-q")).code, 0);
  assert.equal((await run(folder, "sweep", "a.json", "--missing")).out, "\n");
});

test("sweep: array tasks may all begin at once", async (t) => {
  for (let round = 0; round < 3; ++round) {
    const folder = sweepFile(t);
    const tasks = ["1", "2", "3", "8"].map((index) => run(folder, "sweep", "a.json", "--index", index));
    for (const { code, err } of await Promise.all(tasks)) assert.equal(code, 0, err);
    assert.equal((await run(folder, "sweep", "a.json", "--missing")).out, "4-7\n");
  }
});

test("sweep: stopped, it goes on to the same table", async (t) => {
  const iterations = 300;  // so that much is left when it is stopped
  const folder = sweepFile(t, { ...small, job: { ...small.job, budget: { iterations } } });
  assert.equal((await run(folder, "sweep", "a.json")).code, 0);
  // Without times, which differ from run to run.
  const values = () => {
    const times = rows(folder)[0].split(",").map((name) => name.endsWith("seconds"));
    return rows(folder).map((line) => line.split(",").filter((_, i) => !times[i]).join());
  };
  const last = () => values().filter((line) => line.includes(",done,") && line.split(",")[8] === `${iterations}`);
  const undisturbed = last();
  assert.equal(undisturbed.length, 8);
  rmSync(join(folder, "a.sweep"), { recursive: true });
  const begun = start(folder, "sweep", "a.json");
  await until(() => existsSync(join(folder, "a.sweep/runs/0002-1")), "the third run has begun");
  begun.child.kill("SIGTERM");
  const stopped = await begun.ended;
  assert.equal(stopped.code, 75, stopped.err);
  assert.notEqual((await run(folder, "sweep", "a.json", "--missing")).out, "\n");
  assert.equal((await run(folder, "sweep", "a.json")).code, 0);
  assert.deepEqual(last(), undisturbed);
});

test("sweep: killed at once, it leaves no renderer, and goes on", async (t) => {
  const folder = sweepFile(t, { ...small, job: { ...small.job, budget: { seconds: 1.5 } }, seeds: 1, axes: {} , baseline: {} });
  const begun = start(folder, "sweep", "a.json");
  const first = join(folder, "a.sweep/runs/0001-1");
  await until(() => existsSync(join(first, "progress.json")), "the first run renders");
  begun.child.kill("SIGKILL");
  await begun.ended;
  const renderers = () => readdirSync("/proc").filter((pid) => /^\d+$/.test(pid)).filter((pid) => {
    try {
      return readFileSync(`/proc/${pid}/cmdline`, "utf8").includes(`render\0${first}`);
    } catch {
      return false;  // it has ended meanwhile
    }
  });
  await until(() => renderers().length === 0, "its renderer has ended");
  const { code, err } = await run(folder, "sweep", "a.json");
  assert.equal(code, 0, err);
  assert.match(err, /^\[1\/1\] 0001-1 .*done$/m);
});

test("sweep: while a part of the program is away, the runs wait", async (t) => {
  const folder = sweepFile(t, { seeds: 2, job: small.job });
  const copy = join(folder, "bin/lacuna");
  mkdirSync(join(folder, "bin"));
  copyFileSync(program, copy);
  const { child, ended } = startWith(["sh", "-c", 'shift; exec "$0" "$@"', copy], folder, "sweep", "a.json");
  await new Promise((seen) => {
    child.stderr.on("data", (bytes) => /jobs wait: .*lacuna-images\.so/.test(bytes) && seen());
    ended.then(seen);
  });
  const part = join(folder, "bin/lacuna-images.so");
  copyFileSync(`${program}-images.so`, `${part}.new`);
  renameSync(`${part}.new`, part);
  const { code, err } = await ended;
  assert.equal(code, 0, err);
  assert.match(err, /jobs wait: .*lacuna-images\.so[^]*\[2\/2\] 0001-\d.*done/);
});

test("sweep: a run that fails does not stop the others", async (t) => {
  const folder = sweepFile(t, { ...small, seeds: 1, baseline: {}, axes: { "/camera": ["room", "nowhere"], "/seed": [1, 2] } });
  const done = await run(folder, "sweep", "a.json");
  assert.equal(done.code, 1);
  assert.match(done.err, /0003-1 camera nowhere, seed 1: failed: .*nowhere/);
  assert.equal((await run(folder, "sweep", "a.json", "--missing")).out, "3-4\n");
});

test("sweep: mistakes are told before anything is done", async (t) => {
  const folder = sweepFile(t, { ...small, axes: { "/integrator/max_depth": [2, 0] } });
  const bad = await run(folder, "sweep", "a.json");
  assert.equal(bad.code, 2);
  assert.match(bad.err, /\/axes\/~1integrator~1max_depth\/1: found number 0; allowed/);
  assert.equal(existsSync(join(folder, "a.sweep")), false);
  writeFileSync(join(folder, "a.json"), JSON.stringify(small));
  assert.equal((await run(folder, "sweep", "a.json", "--index", "1")).code, 0);
  writeFileSync(join(folder, "a.json"), JSON.stringify({ ...small, seeds: 3 }));
  const other = await run(folder, "sweep", "a.json");
  assert.equal(other.code, 2);
  assert.match(other.err, /contains another sweep; choose another folder with --out/);
});

test("report: what the runs say of their settings, as text, as JSON, and as files", async (t) => {
  const folder = sweepFile(t, { ...small, job: { ...small.job, reference: "auto", reference_iterations: 8,
    budget: { iterations: 1000 } } });
  assert.equal((await run(folder, "sweep", "a.json", "-q")).code, 0);
  const told = await run(folder, "report", "a.sweep");
  assert.equal(told.code, 0, told.err);
  // Two depths, each against its own reference: two pictures, in both of which a baseline is missing or itself.
  assert.match(told.out, /^seconds: relmse, 95 % intervals\n\nmax_depth 2\nlowest error, preparation \(cold\) included:\n/);
  assert.match(told.out, /^ +2 +2\/2 +\(?\S+ \[\S+, \S+\]\)? .*next_event_estimation false$/m);
  assert.ok(existsSync(join(folder, "a.sweep/report.html")));
  rmSync(join(folder, "a.sweep/report.html"));
  const json = await run(folder, "report", "a.sweep", "--json");
  const answers = JSON.parse(json.out);
  assert.deepEqual(answers.states, { done: 8 });
  assert.deepEqual(answers.pictures.map((p) => [p.text, p.cells]), [["max_depth 2", [1, 2]], ["max_depth 4", [3, 4]]]);
  for (const cell of answers.cells) {
    assert.equal(cell.done, 2);
    assert.ok(cell.efficiency.low < cell.efficiency.value && cell.efficiency.value < cell.efficiency.high);
    assert.ok(cell.preparation.cold > 0);
    assert.equal(cell.bias_between_runs.n, 2);
  }
  assert.equal(existsSync(join(folder, "a.sweep/report.html")), false, "--json writes nothing");
  const none = await run(folder, "report", folder);
  assert.equal(none.code, 2);
  assert.match(none.err, /is not a sweep's folder: it has no sweep\.json/);
});

test("report: where runs are compared may change afterwards", async (t) => {
  const folder = sweepFile(t, { ...small, seeds: 1 });
  assert.equal((await run(folder, "sweep", "a.json", "-q")).code, 0);
  writeFileSync(join(folder, "a.json"), JSON.stringify({ ...small, seeds: 1, compare_at: { errors: [0.125] } }));
  assert.equal((await run(folder, "sweep", "a.json", "-q")).code, 0);
  const answers = JSON.parse((await run(folder, "report", "a.sweep", "--json")).out);
  assert.equal(answers.metric, "est_rmse");
  assert.deepEqual(answers.pictures[0].errors, [0.125]);
});
