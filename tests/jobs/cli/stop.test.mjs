// A job ends soon after SIGTERM, whatever it is doing. Each of these computes for a minute or more when the signal comes.
// Moments and limits are CPU time of the job: other processes on the machine do not change them.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";

import { job, start, temporaryFolder } from "./command.mjs";

const allowed = 20;  // CPU seconds: the end takes some tenths of one, the work minutes
const ticks = Number(execFileSync("getconf", ["CLK_TCK"], { encoding: "utf8" }));  // of /proc, a second
const busy = {
  "paths of a thousand edges": {
    scene: "furnace.glb",
    resolution: [64, 64],
    integrator: { type: "bdpt", max_depth: 1000, roulette_depth: 1000 },
  },
  "portals of many regions": {
    scene: "hairball.glb",
    integrator: { type: "path", guide: { type: "portals" } },
    analysis: { resolution: 256 },
  },
};

/// CPU seconds of a process so far; none once it has ended.
function cpuSeconds(pid) {
  try {
    const fields = readFileSync(`/proc/${pid}/stat`, "utf8").replace(/^.*\) /s, "").split(" ");
    return (Number(fields[11]) + Number(fields[12])) / ticks;
  } catch {
    return null;
  }
}

/// Waits until a process has used so much CPU time; false if it ends before.
async function uses(child, seconds) {
  for (;;) {
    if (child.exitCode !== null || child.signalCode !== null) return false;
    if (cpuSeconds(child.pid) >= seconds) return true;
    await pause(5);
  }
}

for (const [name, spec] of Object.entries(busy)) {
  for (const seconds of [0.5, 3]) {
    test(`SIGTERM after ${seconds} CPU s of ${name}: interrupted, and soon`, async (t) => {
      const folder = temporaryFolder(t);
      job(folder, "a.json", spec);
      const { child, ended } = start(folder, "render", "a.json", "-q");
      t.after(() => child.kill("SIGKILL"));
      assert.ok(await uses(child, seconds), "the job is too short for this test");
      child.kill("SIGTERM");
      assert.ok(!await uses(child, seconds + allowed), `it still computes ${allowed} CPU s later`);
      const last = await ended;
      assert.equal(last.code, 75, last.err);
      assert.equal(JSON.parse(readFileSync(join(folder, "a.job/outcome.json"), "utf8")).state, "interrupted");
    });
  }
}
