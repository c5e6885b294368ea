// Server-sent events of a job.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { folders, Service, until } from "./service.mjs";

/// Follows a stream: `events` grows by {name, data}; `end` is when it ended by itself.
async function follow(service, id, signal, headers = {}) {
  return followAll(service, `/api/jobs/${id}/events`, signal, headers);
}

/// A stream that does not end by itself is ended after a minute, so that a test which waits for its end fails.
async function followAll(service, target, signal, headers = {}) {
  const limit = AbortSignal.timeout(60_000);
  const response = await service.fetch(target, { signal: signal ? AbortSignal.any([signal, limit]) : limit, headers });
  assert.equal(response.status, 200);
  assert.equal(response.headers.get("content-type"), "text/event-stream");
  const events = [];
  const read = async () => {
    let text = "";
    for await (const chunk of response.body.pipeThrough(new TextDecoderStream())) {
      text += chunk;
      const parts = text.split("\n\n");
      text = parts.pop();
      for (const part of parts) {
        if (part.startsWith(":")) continue;  // a heartbeat
        const found = /^id: ([0-9a-f]+-\d+)\nevent: (\w+)\ndata: (.*)$/.exec(part);
        assert.ok(found, part);
        events.push({ id: found[1], name: found[2], data: JSON.parse(found[3]) });
      }
    }
  };
  return { events, end: read() };
}

test("a watcher sees every state, the progress, and then the end", async (t) => {
  const service = await Service.start(folders(t));
  const blocker = await service.post("gate first");
  await service.reaches(blocker, "running");
  const id = await service.post("gate second");
  const { events, end } = await follow(service, id);
  const seen = (check) => until(() => events.some(check), "an event");
  await seen((e) => e.name === "state" && e.data.state === "queued");
  service.open("first");
  await seen((e) => e.name === "state" && e.data.state === "running" && e.data.phase === "rendering");
  await seen((e) => e.name === "progress" && e.data.share === 0.25);
  const file = path.join(service.folder(id), "progress.json");
  for (const share of [0.5, 0.75]) {
    fs.writeFileSync(`${file}.new`, JSON.stringify({ ...JSON.parse(fs.readFileSync(file)), share }));
    fs.renameSync(`${file}.new`, file);
    await seen((e) => e.name === "progress" && e.data.share === share);
  }
  service.open("second");
  await end;
  const states = events.filter((e) => e.name === "state").map((e) => e.data.state);
  assert.deepEqual([...new Set(states)], ["queued", "running", "done"]);
  assert.equal(events.at(-1).name, "state");
  assert.equal(events.at(-1).data.exit_code, 0, "the last word");
  assert.equal(events.findLast((e) => e.name === "progress").data.share, 1, "before the end");
  for (const name of ["state", "progress"]) {
    const same = events.filter((e) => e.name === name);
    for (let i = 1; i < same.length; i += 1) {
      assert.notDeepEqual(same[i], same[i - 1], "only changes are sent");
    }
  }
});

test("the stream of a job that is over says so and ends", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("finish");
  await service.reaches(id, "done");
  const { events, end } = await follow(service, id);
  await end;
  assert.deepEqual(events.map((e) => e.name), ["progress", "state"]);
});

test("cancelling is seen", async (t) => {
  const service = await Service.start(folders(t), ["--grace", "1"]);
  const id = await service.post("stubborn");
  await service.reaches(id, "running");
  const { events, end } = await follow(service, id);
  await service.cancel(id);
  await end;
  const states = events.filter((e) => e.name === "state").map((e) => e.data.state);
  assert.ok(states.includes("cancelling"));
  assert.equal(states.at(-1), "cancelled");
});

test("watchers are limited, and their places become free again", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("gate never");
  const aborts = [];
  for (let i = 0; i < 16; i += 1) {
    const abort = new AbortController();
    aborts.push(abort);
    const { events, end } = await follow(service, id, abort.signal);
    end.catch(() => {});
    await until(() => events.length > 0, "a first event");
  }
  const refused = await service.fetch(`/api/jobs/${id}/events`);
  assert.equal(refused.status, 503);
  assert.ok(refused.headers.get("retry-after"));
  assert.equal((await refused.json()).status, 503);
  assert.deepEqual(await service.json("/health"), { status: "ok" });
  aborts[3].abort();
  await until(async () => {
    const abort = new AbortController();
    const { status } = await service.fetch(`/api/jobs/${id}/events`, { signal: abort.signal });
    abort.abort();
    return status === 200;
  }, "a place is free");
  aborts.forEach((a) => a.abort());
});

test("open streams do not delay the end of the service", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("gate never");
  await service.reaches(id, "running");
  const { end } = await follow(service, id);
  end.catch(() => {});
  const asked = Date.now();
  assert.deepEqual(await service.stop(), { code: 0, signal: null });
  // Only the next heartbeat, every 15 s, would tell a stream that nobody listens.
  assert.ok(Date.now() - asked < 12_000);
});

test("who comes back with the last event it saw misses nothing, and hears nothing twice", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("gate go");
  await service.reaches(id, "running");
  const abort = new AbortController();
  const first = await follow(service, id, abort.signal);
  first.end.catch(() => {});
  await until(() => first.events.some((e) => e.name === "state" && e.data.state === "running"), "it runs");
  const last = first.events.at(-1).id;
  abort.abort();
  service.open("go");
  await service.reaches(id, "done");
  const second = await follow(service, id, undefined, { "Last-Event-ID": last });
  await second.end;
  assert.equal(second.events.at(-1).data.state, "done");
  assert.ok(second.events.every((e) => Number(e.id.split("-")[1]) > Number(last.split("-")[1])));
  const third = await follow(service, id, undefined, { "Last-Event-ID": second.events.at(-1).id });
  await third.end;
  assert.deepEqual(third.events, [], "the end was seen");
  const other = await follow(service, id, undefined, { "Last-Event-ID": "0123abcd-5" });
  await other.end;
  assert.deepEqual(other.events.map((e) => e.name), ["progress", "state"], "of another run: what is now");
});

test("the change that tells that a job waits again says for what", async (t) => {
  const service = await Service.start(folders(t), ["--max-attempts", "1"]);
  const { last_event } = await service.json("/api/jobs");
  const id = await service.post("full later");
  const abort = new AbortController();
  const { events, end } = await followAll(service, `/api/events?after=${last_event}`, abort.signal);
  end.catch(() => {});
  // A renderer that lives long enough is also told of while it runs.
  const waits = (attempts) =>
    events.find((e) => e.name === "job" && e.data.attempts === attempts && e.data.state === "queued");
  await until(() => waits(3), "three attempts");
  for (const attempts of [1, 2, 3]) {
    assert.match(waits(attempts).data.obstacle, /No space left on device/, `after attempt ${attempts}`);
  }
  abort.abort();
  service.open("later");
  await service.reaches(id, "done", 60000);
});

test("one stream tells of all jobs, from the list on", async (t) => {
  const service = await Service.start(folders(t));
  const old = await service.post("finish");
  await service.reaches(old, "done");
  const list = await service.json("/api/jobs");
  const id = await service.post("finish");
  await service.reaches(id, "done");
  await service.fetch(`/api/jobs/${old}`, { method: "DELETE" });
  const abort = new AbortController();
  const { events, end } = await followAll(service, `/api/events?after=${list.last_event}`, abort.signal);
  end.catch(() => {});
  await until(() => events.some((e) => e.name === "removed"), "the removal");
  assert.deepEqual(events.find((e) => e.name === "removed").data, { id: old });
  const states = events.filter((e) => e.name === "job").map((e) => e.data);
  assert.ok(states.every((job) => job.id === id), "what the list held is not told again");
  assert.equal(states[0].state, "queued");
  assert.equal(states.at(-1).state, "done");
  const now = await service.json("/api/jobs");
  assert.deepEqual(states.at(-1), now.jobs[0], "an entry of the list");

  const lost = await followAll(service, "/api/events?after=0123abcd-5", abort.signal);
  lost.end.catch(() => {});
  await until(() => lost.events.some((e) => e.name === "reset"), "it is told to list again");
  abort.abort();
});
