// How quickly GET /health is answered while 500 clients are slow, and GET /api/jobs to 64 that poll:
//     node tests/bench/slow_clients.mjs [TRIES]
// Prints one line a kind: "KIND p50 p99 max" in milliseconds. A new connection for each try.
import { spawn } from "node:child_process";
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { folders, Service } from "../server/service.mjs";

const program = path.join(path.dirname(fileURLToPath(import.meta.url)), "../server/slow_clients.mjs");
const tries = Number(process.argv[2] ?? 200);
const sleep = (ms) => new Promise((resolve) => { setTimeout(resolve, ms); });

const cleanups = [];
const service = await Service.start(folders({ after: (f) => cleanups.push(f) }));

function get(target) {
  const begin = performance.now();
  return new Promise((resolve, reject) => {
    http.get({ port: service.port, host: "127.0.0.1", path: target, agent: false }, (response) => {
      response.resume();
      response.on("end", () => (response.statusCode === 200
        ? resolve(performance.now() - begin) : reject(new Error(`status ${response.statusCode}`))));
    }).on("error", reject);
  });
}

function print(kind, times) {
  times.sort((a, b) => a - b);
  const at = (share) => times[Math.min(times.length - 1, Math.floor(share * times.length))].toFixed(1);
  console.log(`${kind.padEnd(24)} p50 ${at(0.5)} ms  p99 ${at(0.99)} ms  max ${at(1)} ms`);
}

async function health(kind) {
  const times = [];
  for (let i = 0; i < tries; i += 1) {
    times.push(await get("/health"));
    await sleep(20);
  }
  print(kind, times);
}

async function pollers(n) {
  const times = [];
  await Promise.all(Array.from({ length: n }, async (_, i) => {
    await sleep(1000 * i / n);
    for (let k = 0; k < 10; k += 1) {
      times.push(await get("/api/jobs"));
      await sleep(1000);
    }
  }));
  print(`${n} that poll`, times);
}

try {
  const id = await service.post("finish");
  await service.reaches(id, "done");
  fs.writeFileSync(path.join(service.folder(id), "image.exr"), Buffer.alloc(32 << 20));
  await health("nobody else");
  await pollers(64);
  for (const kind of ["head", "body", "large body", "chunks", "reader"]) {
    const child = spawn(process.execPath,
      [program, `${service.port}`, kind, "500", `/api/jobs/${id}/files/image.exr`],
      { stdio: ["ignore", "pipe", "inherit"] });
    await new Promise((resolve) => { child.stdout.once("data", resolve); });
    try {
      await health(`500 slow: ${kind}`);
    } finally {
      child.kill("SIGKILL");
    }
  }
} finally {
  for (const cleanup of cleanups) await cleanup();
}
