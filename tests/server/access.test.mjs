// With a token file: who may do what. (Every rule is tested in access_test.cpp; here, that they hold
// in the service, and what its log says.)
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { fakeRenderer, folders, head, runToEnd, Service, until } from "./service.mjs";

const token = "correct-horse-battery";

function tokenFile(places, mode = 0o600) {
  const file = path.join(places.root, "token");
  fs.writeFileSync(file, `${token}\n`);
  fs.chmodSync(file, mode);
  return file;
}

const login = (service, shown, headers = {}) => service.fetch("/api/session", {
  method: "POST", headers: { "Content-Type": "application/json", ...headers },
  body: JSON.stringify({ token: shown }),
});

test("a token opens everything, a session stands for it, and no log shows either", async (t) => {
  const places = folders(t);
  const service = await Service.start(places, ["--token-file", tokenFile(places), "--verbose"]);
  for (const open of ["/", "/app.js", "/health"]) {
    assert.equal((await service.fetch(open)).status, 200, open);
  }
  const bare = await service.fetch("/api/jobs");
  assert.equal(bare.status, 401);
  assert.equal(bare.headers.get("www-authenticate"), "Bearer");
  assert.equal((await bare.json()).status, 401);
  const bearer = { Authorization: `Bearer ${token}` };
  assert.equal((await service.fetch("/api/jobs", { headers: bearer })).status, 200);

  assert.equal((await login(service, "wrong")).status, 401);
  const session = await login(service, token);
  assert.equal(session.status, 204);
  const cookie = session.headers.get("set-cookie");
  assert.match(cookie, /^lacuna_session=[0-9a-f]{64}; Path=\/; HttpOnly; SameSite=Strict$/);
  const secure = await login(service, token, { Origin: `https://127.0.0.1:${service.port}` });
  assert.match(secure.headers.get("set-cookie"), /; Secure$/);
  const shown = { Cookie: cookie.split(";")[0] };
  assert.equal((await service.fetch("/api/jobs", { headers: shown })).status, 200);
  const cancel = (headers) => service.raw(head("POST /api/jobs/20260101-000000-abcdef/cancel", headers));
  assert.equal((await cancel({ ...shown })).status, 403, "without Origin");
  assert.equal((await cancel({ ...shown, Origin: "http://localhost" })).status, 404);
  assert.equal((await cancel({ ...bearer })).status, 404, "no browser sends a token by itself");
  const end = await service.raw(head("DELETE /api/session", { ...shown, Origin: "http://localhost" }));
  assert.equal(end.status, 204);
  assert.equal((await service.fetch("/api/jobs", { headers: shown })).status, 401);

  await until(() => service.log.includes("DELETE /api/session 204"), "the log names requests");
  assert.match(service.log, /GET \/api\/jobs 401 \d+\.\d ms/);
  assert.ok(!service.log.includes(token));
  assert.ok(!service.log.includes(shown.Cookie.split("=")[1]));
});

test("wrong tokens are not tried quickly", async (t) => {
  const places = folders(t);
  const service = await Service.start(places, ["--token-file", tokenFile(places)]);
  const statuses = await Promise.all(Array.from({ length: 200 }, async () => (
    await service.fetch("/api/jobs", { headers: { Authorization: "Bearer wrong-wrong-wrong" } })).status));
  assert.ok(statuses.every((s) => s === 401 || s === 429));
  assert.ok(statuses.includes(401) && statuses.includes(429), "the first are looked at");
  assert.equal((await service.fetch("/api/jobs", { headers: { Authorization: `Bearer ${token}` } })).status, 200,
    "the right one passes");
});

test("without a token there are no sessions", async (t) => {
  const service = await Service.start(folders(t));
  assert.equal((await login(service, token)).status, 404);
});

test("beyond loopback only with a token, and under the names that were given", async (t) => {
  const places = folders(t);
  const service = await Service.start(places, ["--bind", "0.0.0.0", "--token-file", tokenFile(places),
    "--host", "render.example", "--host", "other.example:444"]);
  const status = async (host) => (await service.raw(head("GET /health", { Host: host }))).status;
  for (const own of ["render.example", "render.example:8017", "other.example:444", "localhost"]) {
    assert.equal(await status(own), 200, own);
  }
  for (const other of ["evil.example", "other.example", "other.example:80"]) {
    assert.equal(await status(other), 403, other);
  }
});

test("a token file that others can read, or that is none, is refused", async (t) => {
  const places = folders(t);
  const refused = async (file, message, more = []) => {
    const { code, err } = await runToEnd(["--port", "0", "--data", places.data, "--scenes", places.scenes,
      "--renderer", fakeRenderer, "--token-file", file, ...more]);
    assert.equal(code, 1);
    assert.match(err, message);
    assert.ok(!err.includes(token));
  };
  await refused(tokenFile(places, 0o640), /token: others can access it \(mode 0640\): chmod 600/);
  await refused(path.join(places.root, "none"), /none: No such file/);
  await refused(places.root, /it is not a regular file/);
  await refused(tokenFile(places), /--host "http:\/\/x" is not a host name/, ["--host", "http://x"]);
});
