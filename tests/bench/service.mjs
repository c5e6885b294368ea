// The service with 10,000 jobs:
//     node tests/bench/service.mjs
// prints the figures below and ends with 1 if one is missed.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { setTimeout as pause } from "node:timers/promises";
import { lacuna, ownScenes, startReal } from "../server/real_service.mjs";
import { folders, Service, until } from "../server/service.mjs";
import { bench, figure, quantile } from "./figures.mjs";
import { fill, many } from "./many_jobs.mjs";
import { cpu, poll } from "./polling.mjs";

const clients = 64, window = 8000, pairs = 4;

/// Render time's iterations a second of both jobs together, over `ms`.
async function speed(service, ids, ms, meanwhile) {
  const now = () => ids.map((id) => JSON.parse(fs.readFileSync(path.join(service.folder(id), "progress.json"))));
  const before = now(), times = await meanwhile(ms), after = now();
  const rates = ids.map((_, i) => (after[i].iteration - before[i].iteration) / (after[i].seconds - before[i].seconds));
  return { rate: rates[0] + rates[1], times };
}

async function measure(test) {
  const places = folders(test);
  const plain = await Service.start(places);
  const id = await plain.post("finish");
  await plain.reaches(id, "done");
  const template = plain.folder(id);
  await plain.stop();
  fill(places.data, template);

  const begin = performance.now();
  const service = await startReal({ ...places, scenes: ownScenes }, ["--jobs", "2"]);
  figure(`start with ${many} jobs`, (performance.now() - begin) / 1000, "s", 3);
  const list = await service.json("/api/jobs?limit=1");
  if (list.total !== many + 1) throw new Error(`${list.total} jobs are listed`);

  const spec = { scene: "cornell.glb", resolution: [64, 64], threads: 1, budget: { seconds: 600 } };
  const ids = [];
  for (let k = 0; k < 2; k += 1) ids.push(await service.post(`job ${k}`, { ...spec, seed: k + 1 }));
  for (const one of ids) {
    await until(() => fs.existsSync(path.join(service.folder(one), "progress.json")), "it renders");
  }
  await pause(3000);
  const quiet = [], asked = [], times = [];
  let used = 0;
  for (let i = 0; i < pairs; i += 1) {
    quiet.push((await speed(service, ids, window, pause)).rate);
    const before = cpu(service);
    const busy = await speed(service, ids, window, (ms) => poll(service, ms, clients));
    used += cpu(service) - before;
    asked.push(busy.rate);
    times.push(...busy.times);
  }
  const sum = (list) => list.reduce((a, b) => a + b, 0);
  console.log(`  GET /api/jobs: ${times.length} answers, p50 ${quantile(times, 0.5).toFixed(1)} ms, max ${quantile(times, 1).toFixed(1)} ms`);
  figure(`GET /api/jobs, p99, ${clients} clients once a second, two jobs rendering`, quantile(times, 0.99), "ms", 20);
  console.log(`  meanwhile the service used ${(1000 * used / times.length).toFixed(2)} ms of CPU time an answer`);
  figure("the two jobs are slower by", 100 * (1 - sum(asked) / sum(quiet)), "%", 3);
  await service.stop();
}

/// From POST to the first instruction of the renderer.
async function start(places) {
  const renderer = path.join(places.root, "renderer");
  fs.writeFileSync(renderer, "#!/bin/sh\ndate +%s%N >\"$2/curve.csv\"\nexit 3\n", { mode: 0o755 });
  const service = await Service.start(places, ["--renderer", renderer]);
  const times = [];
  for (let i = 0; i < 40; i += 1) {
    const asked = BigInt(Date.now()) * 1000000n;
    const id = await service.post("x");
    const file = path.join(service.folder(id), "curve.csv");
    await until(() => fs.existsSync(file) && fs.readFileSync(file, "utf8").endsWith("\n"), "it starts");
    times.push(Number(BigInt(fs.readFileSync(file, "utf8").trim()) - asked) / 1e6);
    await service.reaches(id, "failed");
  }
  console.log(`  from POST to the renderer: p50 ${quantile(times, 0.5).toFixed(1)} ms`);
  console.log(`  all: ${times.map((t) => t.toFixed(0)).join(" ")}`);
  figure("from POST to the renderer's first instruction, p90 of 40", quantile(times, 0.9), "ms", 30);
  await service.stop();
}

await bench(async (test) => {
  if (spawnSync(lacuna, ["--version"]).status !== 0) throw new Error("./dev build first");
  await start(folders(test));
  await measure(test);
});
