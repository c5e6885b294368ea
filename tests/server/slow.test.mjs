// 500 slow clients of each kind: another client is answered all the same. The limit here only tells
// "is served" from "waits for the slow ones", which hold their threads for 5 s and more;
// tests/bench/slow_clients.mjs measures.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { folders, Service } from "./service.mjs";

const program = path.join(path.dirname(fileURLToPath(import.meta.url)), "slow_clients.mjs");

async function attack(t, service, kind, target) {
  const child = spawn(process.execPath, [program, `${service.port}`, kind, "500", target],
    { stdio: ["ignore", "pipe", "inherit"] });
  t.after(() => child.kill("SIGKILL"));
  await new Promise((resolve) => { child.stdout.once("data", resolve); });
}

for (const kind of ["head", "body", "large body", "chunks", "reader"]) {
  test(`500 slow clients: ${kind}`, async (t) => {
    const service = await Service.start(folders(t));
    const id = await service.post("finish");
    await service.reaches(id, "done");
    fs.writeFileSync(path.join(service.folder(id), "image.exr"), Buffer.alloc(32 << 20));
    await attack(t, service, kind, `/api/jobs/${id}/files/image.exr`);
    const times = [];
    for (let i = 0; i < 50; i += 1) {
      const begin = performance.now();
      assert.deepEqual(await service.json("/health"), { status: "ok" });
      times.push(performance.now() - begin);
    }
    times.sort((a, b) => a - b);
    assert.ok(times[44] < 2500, `nine of ten are answered in ${times[44]} ms`);
    const other = await service.post("finish");
    await service.reaches(other, "done");
    const image = await service.fetch(`/api/jobs/${other}/files/image.exr`);
    assert.equal((await image.text()).length, 100000);
  });
}

// A child that is being started has every socket until it is another program: what the service has
// closed meanwhile is not closed yet.
test("500 slow clients while renderers are started: the service lives", async (t) => {
  const service = await Service.start(folders(t));
  await attack(t, service, "chunks", "/health");
  const ids = [];
  for (let i = 0; i < 40; i += 1) ids.push(await service.post("finish"));
  for (let done = 0; done < 10;) {
    ({ counts: { done } } = await service.json("/api/jobs?limit=1"));
    await service.json(`/api/jobs/${ids[done]}`);
  }
  assert.equal(service.child.exitCode, null);
});
