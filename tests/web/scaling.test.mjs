// A number of several jobs' reports over another.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";

import { screenshot } from "./browser.mjs";
import { hostile, makeJobs, report } from "./fixtures.mjs";
import { mock, open, page } from "./stage.mjs";

/// Jobs of two methods with 1000, 2000 and 4000 light paths, whose maps take time as their number to a power.
function scalingJobs() {
  const like = makeJobs().at(-1);
  const powers = { megaviews: 0.5, many_lods: 1 };
  return Object.entries(powers).flatMap(([method, power], m) => [1000, 2000, 4000].map((paths, i) => {
    const integrator = { type: "many_lights", light_paths: paths, visibility: { type: "view_maps", method } };
    const told = { ...report, integrator: { virtual_lights: 1.5 * paths, view_map_cpu_seconds: 0.01 * paths ** power } };
    return { ...like, id: `20260130-101400-${m}${i}`, job: { ...like.job, integrator, seed: 10 * m + i, label: `${m} ${i}` },
      files: { ...like.files, "report.json": JSON.stringify(told) } };
  }));
}
const address = (jobs) => `/#/compare?jobs=${jobs.map((j) => j.id).join(",")}`;
const figure = ".plot[data-curves='2'] svg[aria-label='integrator view map cpu seconds against /integrator/light_paths']";
const words = () => page.locator(figure).locator("text").evaluateAll((all) => all.map((t) => t.textContent));

for (const [colorScheme, width] of [["light", 1280], ["dark", 400]]) {
  test(`a number of the reports over a setting, by method, in ${colorScheme} at ${width}`, async () => {
    mock.jobs = scalingJobs();
    await open(`${address(mock.jobs)}&sy=integrator view_map_cpu_seconds`, { colorScheme, viewport: { width, height: 900 } });
    await page.waitForSelector(figure);
    const told = await words();
    for (const name of ["method megaviews: ∝ x^0.50", "method many_lods: ∝ x^1.00", "/integrator/light_paths"]) {
      assert.ok(told.includes(name), `${name} in ${told}`);
    }
    assert.equal(await page.locator(`${figure} .curve`).count(), 2);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
    await page.locator(figure).scrollIntoViewIfNeeded();
    await screenshot(page, `scaling-${colorScheme}-${width}`);
    assert.deepEqual(page.troubles, []);
  });
}

test("the choice is in the address, and a number of the report can be the other axis", async () => {
  mock.jobs = scalingJobs();
  await open(address(mock.jobs));
  await page.getByLabel("Number", { exact: true }).selectOption("integrator view_map_cpu_seconds");
  await page.getByLabel("over", { exact: true }).selectOption("integrator virtual_lights");
  await page.waitForSelector(".plot[data-curves='2'][data-points='6'] svg[aria-label$='against integrator virtual lights']");
  assert.match(decodeURIComponent(page.url()), /sy=integrator.view_map_cpu_seconds&sx=integrator.virtual_lights/);
  const download = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save scaling as SVG" }).click();
  const text = (await readFile(await (await download).path())).toString();
  assert.match(text, /^<svg xmlns="http:\/\/www.w3.org\/2000\/svg"/);
  assert.ok(!/NaN|undefined|style=|var\(/.test(text));
  assert.deepEqual(page.troubles, []);
});

test("jobs without reports, without a difference, and with hostile settings", async () => {
  const heading = page.getByRole("heading", { name: "Scaling" });
  await open("/#/compare?jobs=20260131-101400-cornell,20260131-101500-shallow");
  await page.waitForSelector(".plot svg");
  assert.equal(await heading.isVisible(), false);
  mock.jobs = scalingJobs().map((j) => ({ ...j, files: { "job.json": j.files["job.json"] } }));
  await open(address(mock.jobs));
  await page.getByText("No errors have been measured.").first().waitFor();
  assert.equal(await heading.isVisible(), false);
  mock.jobs = scalingJobs();
  for (const { job } of mock.jobs) job.integrator = { ...job.integrator, visibility: { type: hostile + job.seed } };
  await open(`${address(mock.jobs)}&sy=integrator view_map_cpu_seconds`);
  await page.waitForSelector(".plot[data-curves='6'] svg");
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.deepEqual(page.troubles, []);
});
