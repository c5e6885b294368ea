// Clients that are slow, many, or gone: others are served all the same.
import assert from "node:assert/strict";
import net from "node:net";
import { test } from "node:test";
import { folders, head, Service, until } from "./service.mjs";

/// Opens `n` connections and sends `text` on each.
async function connect(t, service, n, text) {
  const sockets = [];
  t.after(() => sockets.forEach((s) => s.destroy()));
  for (let i = 0; i < n; i += 1) {
    const socket = net.connect(service.port, "127.0.0.1");
    socket.on("error", () => {});
    sockets.push(socket);
    await new Promise((resolve) => { socket.once("connect", resolve); });
    if (text) socket.write(text);
  }
  return sockets;
}

const closed = (socket) => new Promise((resolve) => {
  if (socket.closed) resolve();
  socket.once("close", resolve);
  socket.resume();
});

test("clients that fall silent hold up nobody and are sent away", async (t) => {
  const service = await Service.start(folders(t));
  const silent = await connect(t, service, 20, "");
  const slow = await connect(t, service, 20, "GET /health HTTP/1.1\r\nHost: loc");
  const body = await connect(t, service, 10, `${head("POST /api/jobs", {
    "Content-Type": "application/json", "Content-Length": "1000",
  })}{`);
  assert.deepEqual(await service.json("/health"), { status: "ok" });
  const id = await service.post("finish");
  await service.reaches(id, "done");
  const all = [...silent, ...slow, ...body];
  all.forEach((s) => s.resume());
  await until(() => all.every((s) => s.closed), "they are sent away");
});

test("a reader that takes nothing is given up, others read on", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("finish");
  await service.reaches(id, "done");
  const lazy = await connect(t, service, 5, head(`GET /api/jobs/${id}/files/image.exr`));
  lazy.forEach((s) => s.pause());
  const other = await service.fetch(`/api/jobs/${id}/files/image.exr`);
  assert.equal((await other.text()).length, 100000);
});

test("500 clients at once: each is served", async (t) => {
  const service = await Service.start(folders(t));
  const sockets = await connect(t, service, 500, "");
  const statuses = await Promise.all(sockets.map(async (socket) => {
    let text = "";
    socket.on("data", (d) => { text += d; });
    socket.write(head("GET /health"));
    await closed(socket);
    return Number(text.split(" ")[1]);
  }));
  assert.deepEqual(statuses.filter((s) => s !== 200), []);
  assert.deepEqual(await service.json("/health"), { status: "ok" });
});

test("clients that leave early cost nothing", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("finish");
  await service.reaches(id, "done");
  for (let i = 0; i < 200; i += 1) {
    const [socket] = await connect(t, service, 1, head(`GET /api/jobs/${id}/files/image.exr`));
    socket.destroy();
  }
  assert.deepEqual(await service.json("/health"), { status: "ok" });
});

test("a client that waits for 100 Continue gets it", async (t) => {
  const service = await Service.start(folders(t));
  const job = JSON.stringify({ scene: "room/scene.glb", label: "finish" });
  const [socket] = await connect(t, service, 1, head("POST /api/jobs", {
    "Content-Type": "application/json", "Content-Length": `${job.length}`, Expect: "100-continue",
  }));
  let text = "";
  await new Promise((resolve) => { socket.once("data", (d) => { text += d; resolve(); }); });
  assert.match(text, /^HTTP\/1.1 100 /);
  socket.on("data", (d) => { text += d; });
  socket.write(job);
  await closed(socket);
  assert.match(text, /HTTP\/1.1 201 /);
});

test("a post without a body needs no length", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("gate never");
  const answer = await service.raw(head(`POST /api/jobs/${id}/cancel`));
  assert.ok([200, 202].includes(answer.status));
  await service.reaches(id, "cancelled");
});
