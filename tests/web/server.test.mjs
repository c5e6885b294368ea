// The page against the real service and the real renderer.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";

import { realFolders, startReal } from "../server/real_service.mjs";
import { launch, openPage, ready, screenshot } from "./browser.mjs";
import { states } from "./fixtures.mjs";

const small = { scene: "cornell.glb", resolution: [32, 32], threads: 1, budget: { iterations: 64 } };
const pictured = ".stage[data-shown], .frame img";
const patience = { timeout: 60_000 };  // a busy machine may render slowly

const cleanups = [];
let address;
let browser;

before(async () => {
  const service = await startReal(realFolders({ after: (f) => cleanups.push(f) }));
  address = new URL(service.url).origin;
  browser = await launch();
});

after(async () => {
  await browser?.close();
  for (const cleanup of cleanups) await cleanup();
});

/// Posts a job through the form and waits until it is done; gives its id.
async function render(page, job) {
  await page.goto(`${address}/#/new`);
  await page.waitForSelector("textarea");
  await page.fill("textarea", JSON.stringify(job));
  await page.getByRole("button", { name: "Post the job" }).click();
  const article = page.locator("article[data-state=done], article[data-state=failed]");
  await article.waitFor(patience);
  assert.equal(await article.getAttribute("data-state"), "done", await page.locator(".notes").innerText());
  await page.waitForSelector(".report table", patience);  // what the page reads last
  return page.url().split("/").pop();
}

test("the first job, from the empty list to its curve, picture and report; then a comparison", async () => {
  const page = await openPage(browser, address);
  await page.getByText("No jobs yet").waitFor();
  assert.deepEqual(page.troubles, []);

  const withReference = { ...small, reference: "auto", reference_iterations: 256, label: "measured" };
  const first = await render(page, withReference);
  await page.waitForSelector(pictured);
  assert.ok(Number(await page.locator(".plot").getAttribute("data-points")) >= 1);
  const offered = await page.getByLabel("Error", { exact: true }).locator("option").allInnerTexts();
  assert.deepEqual(offered, ["MAE", "RMSE", "MSE", "relMSE", "SMAPE", "FLIP", "estimated RMSE"]);
  const curve = await (await fetch(`${address}/api/jobs/${first}/files/curve.csv`)).text();
  const told = await page.evaluate(async () => (await import("/job_tables.js")).metrics.map((m) => m.key));
  assert.deepEqual(curve.split("\n", 1)[0].split(",").slice(6, -4), told, "the curve's columns are the page's metrics");
  assert.match(await page.locator(".report").innerText(), /peak memory bytes\s+[\d.]+\s[KMG]iB/);
  for (const name of ["image.exr", "image.png", "layers.half", "layers.json", "curve.csv", "report.json", "job.json"]) {
    assert.equal(await page.locator(".files a", { hasText: name }).count(), 1, name);
  }
  await screenshot(page, "real-job");

  const second = await render(page, { ...small, seed: 2 });
  assert.deepEqual(await page.getByLabel("Error", { exact: true }).locator("option").allInnerTexts(),
    ["estimated RMSE"]);
  await page.goto(`${address}/#/compare?jobs=${first},${second}`);
  await page.waitForSelector(".plot[data-curves='2']");
  await page.waitForSelector(pictured);
  await page.getByRole("button", { name: "Figure …" }).click();
  const download = page.waitForEvent("download", patience);
  await page.locator("dialog").getByRole("button", { name: "PDF" }).click();
  const drawn = await readFile(await (await download).path(), "latin1");
  assert.ok(drawn.startsWith("%PDF") && drawn.includes("/FontFile"));
  await page.locator("dialog").getByRole("button", { name: "Close" }).click();
  await page.locator(".stage").press("p");
  await page.locator(".viewer svg polyline").first().waitFor(patience);
  assert.match(await page.locator(".viewer tbody tr th").first().innerText(), /^E[DGS]*L$/);
  await screenshot(page, "real-compare");

  await page.goto(`${address}/#/`);
  await page.waitForSelector(`tr[data-job="${second}"]`);
  assert.deepEqual(await page.locator("tr[data-job] .badge").allInnerTexts(), ["done", "done"]);
  await page.waitForFunction(() => document.querySelectorAll(".thumb img").length === 2);
  await screenshot(page, "real-jobs");
  assert.deepEqual(page.troubles, []);
});

test("the states that the other tests tell the page are the service's", async () => {
  const told = (await (await fetch(`${address}/api/states`)).json()).states;
  assert.deepEqual(told.map(({ name, terminal, actions }) => ({ name, terminal, actions })), states);
});

test("a running job is followed and cancelled", async () => {
  const page = await openPage(browser, `${address}/#/new`);
  await page.fill("textarea", JSON.stringify({ ...small, budget: { seconds: 600 } }));
  await page.getByRole("button", { name: "Post the job" }).click();
  await page.waitForFunction(() => document.querySelector(".title progress")?.value > 0, null, patience);
  const share = await page.locator(".title progress").evaluate((bar) => bar.value);
  await page.waitForFunction((s) => document.querySelector(".title progress").value > s, share, patience);
  await page.getByRole("button", { name: "Cancel job" }).click();
  await page.locator("dialog").getByRole("button", { name: "Cancel job" }).click();
  await page.waitForSelector("article[data-state=cancelled]", patience);
  assert.deepEqual(page.troubles, []);
});

test("a done job is extended, held on its way, and deleted; the list follows", async () => {
  const page = await openPage(browser, `${address}/#/`);
  const list = await openPage(browser, `${address}/#/`);
  const id = await render(page, { ...small, label: "extended", seed: 3 });
  const row = list.locator(`tr[data-job="${id}"]`);
  await row.locator(".badge.done").waitFor(patience);
  await page.getByRole("button", { name: "Extend …" }).click();
  const field = page.getByRole("textbox", { name: "Budget" });
  assert.equal(await field.inputValue(), "{\"iterations\":128}");
  await field.fill("{\"seconds\":600}");
  await page.getByRole("button", { name: "Extend", exact: true }).click();
  await page.locator(".title .badge.running").waitFor(patience);
  await page.getByRole("button", { name: "Hold" }).click();
  await page.locator("article[data-state=held]").waitFor(patience);
  await row.locator(".badge.held").waitFor(patience);
  await page.getByRole("button", { name: "Higher priority" }).click();
  await page.getByText("priority 1").waitFor(patience);
  await page.getByRole("button", { name: "Release" }).click();
  await page.locator(".title .badge.running").waitFor(patience);
  await page.getByRole("button", { name: "Cancel job" }).click();
  await page.locator("dialog").getByRole("button", { name: "Cancel job" }).click();
  await page.locator("article[data-state=cancelled]").waitFor(patience);
  assert.deepEqual([...page.troubles, ...list.troubles], []);
  await page.getByRole("button", { name: "Delete …" }).click();
  await page.getByRole("button", { name: "Delete for good" }).click();
  await page.waitForSelector("main > h1:text-is('Jobs')");
  await row.waitFor({ state: "detached", ...patience });
  // What either was still reading of the job when it went is not found, which the browser prints.
  const late = (text) => text.includes("status of 404") && text.includes(`/api/jobs/${id}`);
  assert.deepEqual([...page.troubles, ...list.troubles].filter((text) => !late(text)), []);
});

test("problems of a job name their places; its scenes are offered", async () => {
  const page = await openPage(browser, `${address}/#/new`);
  const scenes = await page.getByLabel("Scene").locator("option").allInnerTexts();
  assert.ok(scenes.includes("cornell.glb"), scenes.join(" "));
  await screenshot(page, "real-new");
  await page.fill("textarea", JSON.stringify({ ...small, resolution: [0, 32], integrator: { type: "pth" } }));
  await page.getByRole("button", { name: "Post the job" }).click();
  await page.waitForSelector(".errors li");
  const places = await page.locator(".errors code").allInnerTexts();
  assert.ok(places.includes("/resolution/0"), places.join(" "));
  assert.ok(places.some((place) => place.startsWith("/integrator")), places.join(" "));
  assert.deepEqual(page.troubles.filter((text) => !text.includes("status of 400")), []);
  await page.goto(`${address}/#/job/20200101-000000-nobody`);
  await ready(page);
  await page.getByText("There is no job").waitFor();
});
