// The curves alone, and what is saved of them.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";

import { ready, screenshot } from "./browser.mjs";
import { hostile } from "./fixtures.mjs";
import { mock, open, page } from "./stage.mjs";

const job = "20260131-101400-cornell";
const other = "20260131-101500-shallow";
const both = `/#/compare?jobs=${job},${other}&embed`;

async function saved(kind) {
  const download = page.waitForEvent("download");
  await page.getByRole("button", { name: `Save as ${kind}` }).click();
  const file = await download;
  return { name: file.suggestedFilename(), bytes: await readFile(await file.path()) };
}

for (const [colorScheme, width] of [["light", 1280], ["dark", 400]]) {
  test(`two jobs as one figure in ${colorScheme} at ${width}`, async () => {
    await open(both, { colorScheme, viewport: { width, height: 700 } });
    const words = await page.locator(".figure svg text").allInnerTexts().catch(() => [])
      .then(() => page.locator(".figure svg text").evaluateAll((all) => all.map((t) => t.textContent)));
    for (const expected of ["RMSE (radiance)", "render time (s)", "Cornell box, 6 edges, path · bsdf",
      "slope −1/2 (Monte Carlo)", "at the reference's own noise"]) assert.ok(words.includes(expected), `${words}`);
    assert.equal(await page.locator(".bar").isVisible(), false);
    assert.equal(await page.locator(".figure svg circle").count(), 11 + 1 + 1, "11 points and two in the legend");
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
    await screenshot(page, `figure-${colorScheme}-${width}`);
    assert.deepEqual(page.troubles, []);
  });
}

test("the figure is saved as SVG and as PNG, with its axes", async () => {
  mock.find(job).job.label = hostile;
  await open(`/#/job/${job}?x=iteration&y=relmse&embed`);
  const svg = await saved("SVG");
  assert.equal(svg.name, `lacuna-${job}.svg`);
  const text = svg.bytes.toString();
  assert.match(text, /^<svg xmlns="http:\/\/www.w3.org\/2000\/svg"/);
  assert.ok(text.includes(">iterations<") && text.includes(">relMSE<") && !/NaN|undefined|style=/.test(text));
  assert.ok(text.includes("&lt;img src=x") && !text.includes("<img"));
  const png = await saved("PNG");
  assert.equal(png.name, `lacuna-${job}.png`);
  assert.equal(png.bytes.readUInt32BE(16), 2160);
  assert.ok(png.bytes.length > 20000, `${png.bytes.length} bytes`);
  assert.deepEqual(page.troubles, []);
});

test("from the page to its figure and back, with the choice of axes", async () => {
  await open(`/#/job/${job}`);
  await page.getByLabel("against", { exact: true }).selectOption("iteration");
  await page.getByRole("button", { name: "Figure alone" }).click();
  await page.waitForSelector(".figure svg[aria-label='RMSE (radiance) against iterations']");
  await page.getByRole("button", { name: "Leave the figure" }).click();
  await page.waitForSelector(".plot canvas");
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
