// Sweeps on the page, against the real service and renderer, and the same answers as a report of one file.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { lacuna, ownScenes, realFolders, startReal } from "../server/real_service.mjs";
import { frames, launch, newPage, openPage, ready, screenshot, visit } from "./browser.mjs";
import { hostile } from "./fixtures.mjs";

const depth = "/integrator/max_depth";
const nee = "/integrator/next_event_estimation";
const sweep = {
  label: `${hostile}</script>`, seeds: 3, baseline: { [nee]: false },
  job: { scene: "cornell.glb", camera: "front", reference: "auto", reference_iterations: 4000, budget: { iterations: 1500 } },
  axes: { [depth]: [3, 6], [nee]: [true, false], "/resolution": [[24, 16]] },
};
const patience = { timeout: 120_000 };

const cleanups = [];
let places;
let address;
let browser;
let id;

const overflow = (page) => page.evaluate(() =>
  document.documentElement.scrollWidth - document.documentElement.clientWidth);
const choice = (page, name) => page.getByRole("combobox", { name, exact: true });
// A front whose steps are level has a box without height, which a browser test calls invisible.
const drawn = (page) => page.waitForSelector(".plot svg .front", { state: "attached" });
const column = (page, n) => page.locator(`.sortable tbody tr > :nth-child(${n})`).allInnerTexts();

before(async () => {
  places = realFolders({ after: (f) => cleanups.push(f) });
  const service = await startReal(places);
  address = new URL(service.url).origin;
  browser = await launch();
  const job = { ...sweep.job };
  delete job.camera;
  const posted = await fetch(`${address}/api/sweeps`, { method: "POST",
    headers: { "Content-Type": "application/json" }, body: JSON.stringify({ ...sweep, job }) });
  assert.equal(posted.status, 201, await posted.clone().text());
  ({ id } = await posted.json());
});

after(async () => {
  await browser?.close();
  for (const cleanup of cleanups) await cleanup();
});

test("the list of sweeps leads to one, which is live until it is done", async () => {
  const page = await openPage(browser, `${address}/#/sweeps`);
  await page.getByRole("link", { name: hostile, exact: false }).click();
  await page.waitForSelector(".title .badge.done", patience);
  assert.match(await page.locator("article, main").first().innerText(), /4 cells of .*, 3 seeds: 12 of 12 runs done/);
  assert.equal(await page.locator("main img[src=x]").count(), 0);
  assert.deepEqual(page.troubles, []);
});

test("the figure of a sweep has the shown cells of one picture, with the crop on the screen", async () => {
  const page = await openPage(browser, `${address}/#/sweep/${id}?picture=2&crop=2,3,8,6`);
  await page.waitForSelector(".crops canvas", patience);
  await page.getByRole("button", { name: "Figure …" }).click();
  const asked = page.waitForRequest(/\/api\/figures\?format=svg$/, patience);
  const download = page.waitForEvent("download", patience);
  await page.locator("dialog").getByRole("button", { name: "SVG" }).click();
  const { sweep: of, scenes, methods } = (await asked).postDataJSON();
  assert.deepEqual([of, scenes.length, scenes[0].settings[depth], scenes[0].crops], [id, 1, 6, [[2, 3, 8, 6]]]);
  assert.deepEqual(methods.map((m) => m.settings[nee]).toSorted(), [false, true]);
  assert.equal((readFileSync(await (await download).path(), "utf8").match(/<image/g) ?? []).length, 1 + 3,
    "the whole picture, a crop of each method and of the reference");
  assert.deepEqual(page.troubles, []);
});

test("a sweep says who leads, how sure that is, and at which settings", async () => {
  const page = await openPage(browser, `${address}/#/sweep/${id}`);
  await drawn(page);
  // The depths are measured against references of their own: two pictures.
  const picture = choice(page, "Picture");
  assert.deepEqual(await picture.locator("option").allInnerTexts(), ["max_depth 3", "max_depth 6"]);
  assert.equal(await page.locator(".plot").getAttribute("data-curves"), "2");
  assert.match(await page.locator(".front li").last().innerText(), /to [\d.]+\ss: next_event_estimation true/);
  assert.deepEqual((await column(page, 2)).map((t) => t.split(" ")[0]), ["1", "2"]);
  const gain = await page.locator(".sortable tbody tr").first().locator("td.number .better").first().innerText();
  assert.match(gain, /^\d+(\.\d+)?× \(\d+(\.\d+)?–\d+(\.\d+)?\)$/);
  await screenshot(page, "sweep");
  assert.deepEqual(page.troubles, []);
});

test("its table is sorted, its cells chosen, and both are in the address", async () => {
  const page = await openPage(browser, `${address}/#/sweep/${id}`);
  await page.waitForSelector(".plot svg .curve");
  await page.getByRole("button", { name: "next_event_estimation" }).click();
  assert.deepEqual(await column(page, 3), ["false", "true"]);
  await page.getByRole("button", { name: "next_event_estimation" }).click();
  assert.deepEqual(await column(page, 3), ["true", "false"]);
  await page.getByLabel("Show cell 2").uncheck();
  await choice(page, "Table").selectOption("time to equal error");
  await choice(page, "Time").selectOption("with preparation, cache warm");
  await frames(page);
  assert.equal(await page.locator(".plot svg .curve").count(), 1);
  const link = page.url();
  assert.match(link, /sort=-%2Fintegrator%2Fnext_event_estimation/);
  const other = await openPage(browser, link);
  await other.waitForSelector(".plot svg .curve");
  assert.deepEqual(await column(other, 3), ["true", "false"]);
  assert.equal(await other.locator(".plot svg .curve").count(), 1);
  assert.equal(await choice(other, "Table").inputValue(), "error");
  assert.equal(await choice(other, "Time").inputValue(), "warm");
  await other.waitForSelector(".viewer .crops canvas, .stage[data-shown]");
  await other.setViewportSize({ width: 390, height: 800 });
  await frames(other);
  assert.equal(await overflow(other), 0, "no sideways scrolling at 390 pixels");
  await screenshot(other, "sweep-narrow");
  assert.deepEqual([...page.troubles, ...other.troubles], []);
});

test("a report is one file that needs no server and says the same", async () => {
  const folder = join(places.data, "sweeps", id);
  execFileSync(lacuna, ["report", folder, "--quiet"], { env: { ...process.env, LACUNA_SCENES: ownScenes } });
  const file = join(folder, "report.html");
  assert.doesNotMatch(readFileSync(file, "utf8"), /(src|href)="(?!data:)/, "nothing is loaded from elsewhere");
  const page = await newPage(browser);
  page.troubles = [];
  page.home = "";
  await page.goto(pathToFileURL(file).href);
  await drawn(page);
  assert.ok((await page.locator("h1").innerText()).startsWith(hostile));
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.equal(await page.locator(".crops img").count(), 3);  // the reference and two cells
  await choice(page, "Picture").selectOption("max_depth 6");
  await page.waitForFunction(() => [...document.querySelectorAll(".crops img")].every((i) => i.naturalWidth > 0));
  assert.match(page.url(), /#\/\?picture=2$/);
  const same = await openPage(browser, `${address}/#/sweep/${id}?picture=2`);
  await drawn(same);
  assert.deepEqual(await page.locator(".front li").allInnerTexts(), await same.locator(".front li").allInnerTexts());
  await screenshot(page, "report");
  assert.deepEqual([...page.troubles, ...same.troubles], []);
});

test("its runs are jobs, which lead back to it", async () => {
  const page = await openPage(browser, `${address}/#/sweep/${id}`);
  await page.getByRole("link", { name: "its runs" }).click();
  await page.waitForURL((url) => url.hash === `#/?sweep=${id}`, patience);
  await page.getByText("12 of 12", { exact: true }).waitFor(patience);
  await page.locator(".jobs tbody tr").first().getByRole("link").first().click();
  await page.getByRole("link", { name: id }).press("Enter");  // pictures that come late move it from under a click
  await drawn(page);
  await page.goto(`${address}/#/?sweep=20260131-000000-aaaaaa`);
  await page.getByText("No job matches the filter.").waitFor();
  await page.getByRole("button", { name: "of one sweep ×" }).click();
  await page.waitForSelector(".jobs tbody tr");
  assert.deepEqual(page.troubles, []);
});

test("a sweep is deleted with its jobs, and only after a question", async () => {
  const page = await openPage(browser, `${address}/#/sweep/${id}`);
  await page.getByRole("button", { name: "Delete …" }).click();
  await page.getByRole("button", { name: "Delete for good" }).click();
  await page.waitForURL(/#\/sweeps$/);
  await ready(page);
  await page.getByText("No sweeps yet").waitFor();
  assert.equal((await fetch(`${address}/api/sweeps/${id}`)).status, 404);
  await visit(page, `${address}/#/sweep/${id}`);
  await page.getByRole("heading", { name: "Not Found" }).waitFor();
});
