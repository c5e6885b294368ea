// How far one data folder and one merge go:
//     node tests/bench/scale.mjs [JOBS [SHARDS]]
// replays JOBS (default 100,000) job folders, of which every tenth waits, with a stand-in for Slurm that
// answers from a table, and merges SHARDS (default 128) shards; prints the figures below and ends with 1 if
// one is missed. docs/scaling.md says what they mean.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { setTimeout as pause } from "node:timers/promises";

import { lacuna, ownScenes, startReal } from "../server/real_service.mjs";
import { folders, Service, until } from "../server/service.mjs";
import { bench, figure, quantile } from "./figures.mjs";
import { fill } from "./many_jobs.mjs";
import { cpu, memory, poll } from "./polling.mjs";
import { tableSlurm } from "./table_slurm.mjs";

const jobs = Number(process.argv[2] ?? 100000), shards = Number(process.argv[3] ?? 128);
const clients = 64, window = 10000, posted = 300, atATime = 512;

const say = (text) => console.log(`  ${text}`);
const listOf = (folder) => fs.readdirSync(folder).map((name) => [name, fs.statSync(path.join(folder, name))]);

/// Files, bytes, and bytes on the disk of a folder.
function sizes(folder) {
  const all = listOf(folder);
  return { files: all.length, bytes: all.reduce((n, [, s]) => n + s.size, 0),
    onDisk: all.reduce((n, [, s]) => n + 512 * s.blocks, fs.statSync(folder).blocks * 512) };
}

function tellSizes(what, folder) {
  const { files, bytes, onDisk } = sizes(folder);
  say(`${what}: ${files} files, ${files + 1} inodes, ${bytes} bytes, ${onDisk} on the disk`);
}

/// System calls by name that a command makes; null where there is no strace.
function calls(root, command, ...args) {
  const out = path.join(root, "calls");
  const done = spawnSync("strace", ["-f", "-c", "-o", out, command, ...args],
    { cwd: root, encoding: "utf8", env: { ...process.env, LACUNA_DATA: path.join(root, "other"), LACUNA_SCENES: ownScenes } });
  if (done.error) return null;
  if (done.status !== 0) throw new Error(done.stderr);
  return new Map(fs.readFileSync(out, "utf8").split("\n").map((line) => line.trim().split(/\s+/))
    .filter((f) => /^\d/.test(f[0]) && f.at(-1) !== "total").map((f) => [f.at(-1), Number(f[3])]));
}

const metadata = ["openat", "open", "newfstatat", "stat", "lstat", "fstat", "access", "rename", "renameat2", "unlink", "mkdir", "rmdir",
  "fsync", "getdents64", "flock", "readlink", "statx"];
const metadataOf = (counts) => metadata.reduce((n, name) => n + (counts.get(name) ?? 0), 0);

/// A start of the service to its first answer, and its memory then.
async function start(places, name, allowed, options, wrapper) {
  const begin = performance.now();
  const service = await Service.start(places, options, wrapper);
  const seconds = (performance.now() - begin) / 1000;
  const list = await service.json("/api/jobs?limit=1");
  if (list.total < jobs) throw new Error(`${list.total} jobs are listed`);
  say(`${name}: ${cpu(service).toFixed(1)} CPU seconds, ${memory(service).now.toFixed(0)} MB`);
  if (allowed) figure(name, seconds, "s", allowed);
  else say(`${name}: ${seconds.toFixed(1)} s`);
  return service;
}

/// Submissions a second while clients look.
async function submit(service, table, before) {
  const lines = () => fs.readFileSync(table, "utf8").split("\n").length - 1;
  await until(() => lines() >= before + atATime, "the waiting jobs are submitted", 600000);
  await service.fetch("/api/jobs?limit=1");
  const ids = [];
  const times = [];
  let over = false;
  const looking = (async () => { while (!over) times.push(...await poll(service, 1000, clients)); })();
  const begin = performance.now(), used = cpu(service);
  for (let i = 0; i < posted; i += 1) ids.push(await service.post(`posted ${i}`, { threads: 1 }));
  const seconds = (performance.now() - begin) / 1000;
  over = true;
  await looking;
  say(`${posted} jobs are accepted at ${(posted / seconds).toFixed(0)} a second, ${(1000 * (cpu(service) - used) / posted).toFixed(1)} ms of CPU time each, with what the clients cost`);
  figure(`GET /api/jobs meanwhile, p99 of ${times.length}`, quantile(times, 0.99), "ms", 40);
}

async function service(test) {
  const places = folders(test);
  const real = await startReal({ ...places, scenes: ownScenes });
  const id = await real.post("template", { scene: "cornell.glb", resolution: [64, 64], budget: { iterations: 4 } });
  await real.reaches(id, "done");
  const template = real.folder(id);
  await real.stop();
  tellSizes("a finished job of 64 x 64 pixels", template);
  const copy = path.join(places.root, "counted.json");
  fs.copyFileSync(path.join(template, "job.json"), copy);
  const counts = calls(places.root, lacuna, "render", "-q", copy);
  if (counts) say(`to render it takes ${metadataOf(counts)} metadata calls: ${[...counts].filter(([n]) => metadata.includes(n)).map(([n, c]) => `${n} ${c}`).join(", ")}`);
  fill(places.data, template, { count: jobs, every: 10 });

  const { environment, table } = tableSlurm(places.root, 0);
  const options = ["--executor", "slurm", "--jobs", String(atATime), "--max-jobs", String(2 * jobs)];
  const began = performance.now();
  let served = await start(places, `${jobs} jobs without an index`, 0, options, environment);
  const lines = () => fs.readFileSync(table, "utf8").split("\n").length - 1;
  await until(() => lines() >= atATime, "the waiting jobs are submitted", 600000);
  say(`the first ${atATime} are submitted ${((performance.now() - began) / 1000).toFixed(1)} s after the start`);
  await pause(4000);
  await served.stop();
  const index = path.join(places.data, "jobs.index");
  say(`the index: ${(fs.statSync(index).size / 1e6).toFixed(1)} MB`);

  served = await start(places, `start with ${jobs} jobs`, 5, options, environment);
  await pause(3000);
  const before = cpu(served);
  const times = await poll(served, window, clients);
  figure(`GET /api/jobs, p99 of ${times.length}`, quantile(times, 0.99), "ms", 20);
  say(`p50 ${quantile(times, 0.5).toFixed(1)} ms, max ${quantile(times, 1).toFixed(1)} ms; ${(1000 * (cpu(served) - before) / times.length).toFixed(2)} ms of CPU time an answer`);
  await submit(served, table, 0);
  figure("memory at most", memory(served).most, "MB", 300);
  await served.stop("SIGKILL");
  served = await start(places, `start with ${jobs} jobs after a kill`, 5, options, environment);
  await served.stop();
}

/// Shards of one job, all alike, and their merge.
function merge(test) {
  const { root } = folders(test);
  const run = (...args) => {
    const begin = performance.now();
    const done = spawnSync(lacuna, [...args, "-q"], { cwd: root, encoding: "utf8",
      env: { ...process.env, LACUNA_DATA: root, LACUNA_SCENES: ownScenes } });
    if (done.status !== 0) throw new Error(`lacuna ${args.join(" ")}: ${done.stderr}`);
    return (performance.now() - begin) / 1000;
  };
  const cost = (n, side) => {
    const name = `m${n}-${side}`;
    fs.writeFileSync(path.join(root, `${name}.json`), JSON.stringify({ scene: "cornell.glb", resolution: [side, side], threads: 1,
      shards: n, budget: { iterations: 2 * n } }));
    const made = Array.from({ length: n }, (_, k) => {
      run("render", `${name}.json`, "--shard", `${k + 1}/${n}`, "--out", `${name}.${k}.job`);
      return `${name}.${k}.job`;
    });
    const seconds = run("merge", `${name}.job`, ...made);
    const report = JSON.parse(fs.readFileSync(path.join(root, `${name}.job/report.json`)));
    const peak = report.machine.peak_memory_bytes;
    const shard = sizes(path.join(root, made[0]));
    const checkpoint = fs.statSync(path.join(root, made[0], "checkpoint.bin")).size;
    say(`${n} shards of ${side} x ${side}: merged in ${seconds.toFixed(2)} s, ${(peak / 1e6).toFixed(0)} MB; a shard has ${shard.files} files, ${shard.bytes} bytes, of which the checkpoint ${checkpoint}`);
    const counts = calls(root, lacuna, "merge", `${name}.again.job`, ...made.map((m) => path.join(root, m)), "-q");
    return { seconds, peak, calls: counts ? metadataOf(counts) : 0 };
  };
  const further = (few, many, n, side) => {
    const each = (key) => (many[key] - few[key]) / n;
    say(`each further shard of ${side} x ${side}: ${(1000 * each("seconds")).toFixed(1)} ms, ${each("calls").toFixed(1)} metadata calls`);
  };
  const few = cost(shards / 8, 256), many = cost(shards, 256);
  further(few, many, 7 * shards / 8, 256);
  further(cost(shards / 16, 512), cost(shards / 4, 512), 3 * shards / 16, 512);
  figure(`memory of merging ${shards} shards / ${shards / 8} shards`, many.peak / few.peak, "", 1.1);
}

await bench(async (test) => {
  if (spawnSync(lacuna, ["--version"]).status !== 0) throw new Error("./dev build first");
  if (shards > 0) merge(test);
  if (jobs > 0) await service(test);
});
