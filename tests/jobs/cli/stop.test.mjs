// A job answers SIGTERM wherever it is. Each of these is busy for a minute or more at the moment it is told to stop.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";

import { job, start, temporaryFolder } from "./command.mjs";

const allowed = 20;  // seconds: an answer takes some tenths of one, the work minutes
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

for (const [name, spec] of Object.entries(busy)) {
  for (const seconds of [0.5, 3]) {
    test(`SIGTERM after ${seconds} s of ${name}: interrupted, and soon`, async (t) => {
      const folder = temporaryFolder(t);
      job(folder, "a.json", spec);
      const { child, ended } = start(folder, "render", "a.json", "-q");
      t.after(() => child.kill("SIGKILL"));
      await pause(1000 * seconds);
      assert.equal(child.exitCode, null, "the job is too short for this test");
      child.kill("SIGTERM");
      const late = new AbortController();
      const last = await Promise.race([ended, pause(1000 * allowed, null, { signal: late.signal })]);
      late.abort();
      assert.ok(last, `no answer within ${allowed} s`);
      assert.equal(last.code, 75, last.err);
      assert.equal(JSON.parse(readFileSync(join(folder, "a.job/outcome.json"), "utf8")).state, "interrupted");
    });
  }
}
