// The page of the real service behind a token: asked once, kept, refused, and asked again.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";

import { realFolders, startReal } from "../server/real_service.mjs";
import { launch, openPage, ready, screenshot } from "./browser.mjs";

const token = "correct-horse-battery";
const small = { scene: "cornell.glb", resolution: [16, 16], threads: 1, budget: { iterations: 4 } };
const patience = { timeout: 60_000 };  // a busy machine may render slowly

const viewOf = (service, view) => new URL(view, service.url).href;

let browser;
before(async () => { browser = await launch(); });
after(() => browser.close());

/// A service that asks for the token, as whoever has it speaks to it.
async function guarded(t, args = []) {
  const places = realFolders(t);
  const file = path.join(places.root, "token");
  fs.writeFileSync(file, `${token}\n`, { mode: 0o600 });
  const service = await startReal(places, ["--token-file", file, ...args]);
  const headers = { Authorization: `Bearer ${token}`, "Content-Type": "application/json" };
  const post = async (job) => {
    const response = await service.postText(JSON.stringify({ ...small, ...job }), headers);
    assert.equal(response.status, 201);
    return (await response.json()).id;
  };
  return { service, post, again: () => startReal(places, ["--token-file", file, "--port", String(service.port), ...args]) };
}

const field = (page) => page.getByRole("textbox", { name: "Token" });
const submit = (page) => page.getByRole("button", { name: "Continue" }).click();
async function logIn(page) {
  await field(page).fill(token);
  await submit(page);
  await page.waitForSelector("dialog", { state: "detached" });
}
/// What a browser prints of every refused request is no trouble here.
const surprises = (page) => page.troubles.filter((text) => !/status of 40[13]/.test(text));

test("the token opens the list, its events and its pictures; a reload does not ask again", async (t) => {
  const { service, post } = await guarded(t);
  const first = await post({ label: "before" });
  const page = await openPage(browser, service.url, { wait: false });
  t.after(() => page.context().close());
  await field(page).fill("wrong-wrong-wrong");
  await submit(page);
  await page.locator("dialog .problem").waitFor();
  await screenshot(page, "real-token");
  assert.match(await page.locator("dialog .problem").innerText(), /token/i);
  await logIn(page);
  await page.waitForSelector(`tr[data-job="${first}"]`);

  const second = await post({ label: "later" });
  await page.locator(`tr[data-job="${second}"] .badge.done`).waitFor(patience);
  await page.waitForFunction(() => document.querySelectorAll(".thumb img").length === 2);
  assert.equal(await page.locator("#link-state").innerText(), "", "events can be had");

  await page.reload();
  await ready(page);
  await page.waitForSelector(`tr[data-job="${second}"]`);
  assert.equal(await page.locator("dialog").count(), 0);
  const other = await openPage(browser, viewOf(service, `/#/job/${first}`), { context: page.context() });
  await other.waitForSelector(".stage[data-shown]", patience);
  assert.deepEqual([...surprises(page), ...surprises(other)], []);
});

test("what changes something works with the session; a service that has forgotten it asks again", async (t) => {
  const { service, post, again } = await guarded(t);
  const running = await post({ budget: { seconds: 600 } });
  const page = await openPage(browser, viewOf(service, `/#/job/${running}`), { wait: false });
  t.after(() => page.context().close());
  await logIn(page);
  await page.locator(".title .badge.running").waitFor(patience);
  await page.getByRole("button", { name: "Hold" }).click();
  await page.locator("article[data-state=held]").waitFor(patience);

  await page.goto(viewOf(service, "/#/"));
  await page.locator(`tr[data-job="${running}"] .badge.held`).waitFor();
  await service.stop();
  const next = await again();
  await field(page).waitFor(patience);
  await logIn(page);
  const late = await next.postText(JSON.stringify({ ...small, label: "late" }),
    { Authorization: `Bearer ${token}`, "Content-Type": "application/json" });
  const { id } = await late.json();
  await page.waitForSelector(`tr[data-job="${id}"]`, patience);
});

test("who does not show the token is told so, and can be asked again", async (t) => {
  const { service } = await guarded(t);
  const page = await openPage(browser, service.url, { wait: false });
  t.after(() => page.context().close());
  await field(page).press("Escape");
  await page.getByRole("heading", { name: "Token needed" }).waitFor();
  await screenshot(page, "real-token-refused");
  await page.getByRole("button", { name: "Try again" }).click();
  await logIn(page);
  await page.getByText("No jobs yet").waitFor();
});
