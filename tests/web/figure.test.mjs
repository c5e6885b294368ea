// The curves alone, and what is saved of them.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";

import { longestTask, ready, screenshot } from "./browser.mjs";
import { hostile, manyJobs } from "./fixtures.mjs";
import { mock, open, page } from "./stage.mjs";

const job = "20260131-101400-cornell";
const other = "20260131-101500-shallow";
const both = `/#/compare?jobs=${job},${other}&embed`;

async function saved() {
  const download = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save as SVG" }).click();
  const file = await download;
  return { name: file.suggestedFilename(), bytes: await readFile(await file.path()) };
}

for (const [colorScheme, width] of [["light", 1280], ["dark", 400]]) {
  test(`two jobs as one figure in ${colorScheme} at ${width}`, async () => {
    await open(both, { colorScheme, viewport: { width, height: 700 } });
    await page.waitForSelector(".plot svg");
    const words = await page.locator(".plot svg text").evaluateAll((all) => all.map((t) => t.textContent));
    for (const expected of ["RMSE (radiance)", "render time (s)", "Cornell box, 6 edges, path · bsdf",
      "slope −1/2 (Monte Carlo)", "hollow: at the reference's own noise"]) assert.ok(words.includes(expected), `${words}`);
    assert.equal(await page.locator(".bar").isVisible(), false);
    assert.equal(await page.locator(".plot svg circle").count(), 11 + 1 + 1, "11 points and two in the legend");
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
    await screenshot(page, `figure-${colorScheme}-${width}`);
    assert.deepEqual(page.troubles, []);
  });
}

test("the figure is saved as SVG, with its axes", async () => {
  mock.find(job).job.label = hostile;
  await open(`/#/job/${job}?x=iteration&y=relmse&embed`);
  const svg = await saved();
  assert.equal(svg.name, "lacuna-relmse.svg");
  const text = svg.bytes.toString();
  assert.match(text, /^<svg xmlns="http:\/\/www.w3.org\/2000\/svg"/);
  assert.ok(text.includes(">iterations<") && text.includes(">relMSE<") && !/NaN|undefined|style=/.test(text));
  assert.ok(text.includes("&lt;img src=x") && !text.includes("<img"));
  assert.deepEqual(page.troubles, []);
});

test("from the page to its figure and back, with the choice of axes", async () => {
  await open(`/#/job/${job}`);
  await page.getByLabel("against", { exact: true }).selectOption("iteration");
  await page.getByRole("button", { name: "Figure alone" }).click();
  await page.waitForSelector(".plot svg[aria-label='RMSE (radiance) against iterations']");
  await page.getByRole("button", { name: "Leave the figure" }).click();
  await page.waitForSelector("article .plot svg");
  assert.ok(page.url().endsWith(`#/job/${job}?x=iteration`), page.url());
  assert.equal(await page.locator(".bar").isVisible(), true);
  await page.goto(`${page.url().split("#")[0]}#/compare?jobs=${job}&embed`);
  await page.getByRole("button", { name: "Leave the figure" }).click();
  await ready(page);
  assert.ok(page.url().endsWith(`#/compare?jobs=${job}`), page.url());
});

test("a figure without values, and one of a job that is not there", async () => {
  await open("/#/job/20260131-101700-hostile?embed");
  await page.getByText("No errors have been measured.").waitFor();
  assert.equal(await page.getByRole("button", { name: "Save as SVG" }).isVisible(), false);
  await page.goto(`${page.url().split("#")[0]}#/job/nobody?embed`);
  await page.getByText("There is no job nobody.").waitFor();
});

test("twenty curves are laid over one another without a pause", async () => {
  mock.jobs = manyJobs(20, 40);
  await page?.computed();
  const began = performance.now();
  await open(`/#/compare?jobs=${mock.jobs.map((j) => j.id).join(",")}`);
  await page.waitForSelector(".plot[data-curves='20'] svg");
  const shown = performance.now() - began;
  const loading = await longestTask(page, true);
  const busyLoading = await page.computed();
  await page.getByLabel("against", { exact: true }).selectOption("iteration");
  const switching = await longestTask(page, true);
  const busy = await page.computed();
  await page.waitForSelector(".stage[data-shown]");
  await page.getByLabel("Pictures", { exact: true }).selectOption("crops");
  await page.waitForFunction(() => document.querySelectorAll(".crops canvas").length === 20);
  const crops = await longestTask(page);
  console.log(`# 20 curves of 40 points: shown ${shown.toFixed(0)} ms after the browser was asked; longest task ${loading} ms `
    + `while loading, ${switching} ms for another axis, ${crops} ms for 20 crops (0: none above 50); the page computed ${busyLoading} ms and ${busy} ms for the first two`);
  assert.ok(Math.max(busyLoading, busy) < 1000);
  assert.equal(await page.locator(".plot svg .curve").count(), 20);
  const looks = await page.locator(".curve").evaluateAll((all) => all.map((g) => {
    const mark = g.children[1];
    return `${mark.tagName} ${mark.getAttribute("stroke")} ${mark.getAttribute("d")?.replace(/^M[^l]*/, "")}`;
  }));
  assert.equal(new Set(looks).size, 20, "no two curves look the same");
  await screenshot(page, "compare-20");
  assert.deepEqual(page.troubles, []);
});
