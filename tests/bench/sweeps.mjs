// Sweeps: what a run costs beside its rendering, from the command line and through the service, and how soon
// Chromium shows the report of 200 runs:
//     node tests/bench/sweeps.mjs [RUNS]
// RUNS (default 60) are of one second each.
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

import { lacuna, ownScenes, realFolders, startReal } from "../server/real_service.mjs";
import { launch, newPage } from "../web/browser.mjs";
import { bench, figure } from "./figures.mjs";

const runs = Number(process.argv[2] ?? 60);

const sweepOf = (count, budget) => ({
  label: "bench", seeds: 4, baseline: { "/integrator/roulette_depth": 2 },
  job: { scene: "ajar.glb", camera: "room", resolution: [160, 90], budget, reference: "auto", reference_iterations: 64 },
  axes: { "/integrator/roulette_depth": Array.from({ length: count / 4 }, (_, i) => i + 2) },
});

function command(folder, ...args) {
  const done = spawnSync(lacuna, args, { cwd: folder, encoding: "utf8",
    env: { ...process.env, LACUNA_DATA: folder, LACUNA_SCENES: ownScenes } });
  if (done.status !== 0) throw new Error(`lacuna ${args.join(" ")}: ${done.stderr}`);
  return done.stdout;
}

function write(folder, sweep) {
  writeFileSync(join(folder, "a.json"), JSON.stringify(sweep));
  // The reference is made once, by whoever needs it first: not here.
  writeFileSync(join(folder, "first.json"), JSON.stringify({ ...sweep.job, budget: { iterations: 1 } }));
  command(folder, "render", "first.json", "--quiet");
}

/// Percent of the runs' own seconds.
const overhead = (name, seconds) => figure(name, 100 * (seconds / runs - 1), "%", 15);

function fromTheShell(folder) {
  write(folder, sweepOf(runs, { seconds: 1 }));
  const begin = performance.now();
  command(folder, "sweep", "a.json", "--quiet");
  overhead(`overhead of ${runs} one-second runs, lacuna sweep`, (performance.now() - begin) / 1000);
}

async function throughTheService(t) {
  const service = await startReal(realFolders(t));
  const { job } = sweepOf(runs, { iterations: 1 });
  await service.reaches(await service.post("first", job), "done", 60_000);
  const body = JSON.stringify(sweepOf(runs, { seconds: 1 }));
  const begin = performance.now();
  const posted = await service.fetch("/api/sweeps", { method: "POST", body, headers: { "Content-Type": "application/json" } });
  const { id } = await posted.json();
  let last;
  do {
    await new Promise((resolve) => { setTimeout(resolve, 100); });
    last = await (await service.fetch("/api/sweeps")).json();
  } while (last.sweeps[0].state === "running");
  overhead(`overhead of ${runs} one-second runs, the service`, (performance.now() - begin) / 1000);
  const asked = performance.now();
  const answers = await (await service.fetch(`/api/sweeps/${id}/answers`)).json();
  console.log(`its answers took ${(performance.now() - asked).toFixed(0)} ms`);
  if (answers.states.done !== runs) throw new Error(JSON.stringify(answers.states));
  await service.stop();
}

async function report(folder) {
  rmSync(join(folder, "a.sweep"), { recursive: true });
  write(folder, sweepOf(200, { iterations: 40 }));
  command(folder, "sweep", "a.json", "--quiet", "--jobs", "2");
  command(folder, "report", "a.sweep", "--quiet");
  const browser = await launch();
  let least = Infinity;
  for (let round = 0; round < 3; round += 1) {
    const page = await newPage(browser);
    const begin = performance.now();
    await page.goto(pathToFileURL(join(folder, "a.sweep/report.html")).href);
    await page.waitForSelector(".plot svg");
    await page.waitForFunction(() => document.querySelectorAll(".sortable tbody tr").length === 50);
    least = Math.min(least, performance.now() - begin);
    await page.close();
  }
  await browser.close();
  figure("a report of 200 runs is seen", least, "ms", 1000);
}

await bench(async (t) => {
  const folder = mkdtempSync(join(tmpdir(), "lacuna-bench-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  fromTheShell(folder);
  await throughTheService(t);
  await report(folder);
});
