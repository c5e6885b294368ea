// 500 slow clients of each kind: another client is answered while all of them are connected.
// tests/bench/slow_clients.mjs measures how quickly.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { folders, Service, until } from "./service.mjs";

const program = path.join(path.dirname(fileURLToPath(import.meta.url)), "slow_clients.mjs");

async function attack(t, service, kind, target) {
  const child = spawn(process.execPath, [program, `${service.port}`, kind, "500", target],
    { stdio: ["ignore", "pipe", "inherit"] });
  t.after(() => child.kill("SIGKILL"));
  await new Promise((resolve) => { child.stdout.once("data", resolve); });
}

async function openConnections(service) {
  const metrics = await (await service.fetch("/metrics")).text();
  return Number(/^lacuna_http_connections (\d+)$/m.exec(metrics)[1]);
}

for (const kind of ["head", "body", "large body", "chunks", "reader"]) {
  test(`500 slow clients: ${kind}`, async (t) => {
    const service = await Service.start(folders(t));
    const id = await service.post("finish");
    await service.reaches(id, "done");
    fs.writeFileSync(path.join(service.folder(id), "image.exr"), Buffer.alloc(32 << 20));
    await attack(t, service, kind, `/api/jobs/${id}/files/image.exr`);
    // Answers that come while the slow ones are connected did not wait for them to leave.
    let served = 0;
    await until(async () => {
      assert.deepEqual(await service.json("/health"), { status: "ok" });
      served += await openConnections(service) > 500;
      return served >= 10;
    }, "ten requests are served beside 500 open connections");
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
  await until(async () => {
    const { counts: { done } } = await service.json("/api/jobs?limit=1");
    await service.json(`/api/jobs/${ids[Math.min(done, ids.length - 1)]}`);
    return done >= 10;
  }, "ten jobs are done");
  assert.equal(service.child.exitCode, null);
});
