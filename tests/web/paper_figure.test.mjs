// Figures that the service draws of what is on the screen, and the paths of a pixel.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";

import { frames, screenshot } from "./browser.mjs";
import { layerFiles } from "./layers.mjs";
import { mock, open, page } from "./stage.mjs";

const job = "20260131-101400-cornell";
const other = "20260131-101500-shallow";
const rgb = ["R", "G", "B"];
const layers = () => layerFiles(40, 30, [
  { name: "", channels: rgb, pixel: (x, y) => [x / 40, y / 30, 0.5] },
  { name: "reference", channels: rgb, pixel: (x, y) => [x / 40, y / 30, 0.25] }]);
const stage = ".stage[data-shown]";

async function compare(query) {
  for (const id of [job, other]) mock.update(id, { files: layers() });
  await open(`/#/compare?jobs=${job},${other}${query}`);
  await page.waitForSelector(stage);
}

const opened = () => page.getByRole("button", { name: "Figure …" }).click();
const button = (name) => page.locator("dialog").getByRole("button", { name, exact: true });
async function saved(name) {
  const download = page.waitForEvent("download");
  await button(name).click();
  const file = await download;
  return { name: file.suggestedFilename(), text: await readFile(await file.path(), "utf8") };
}

test("a figure has the crop, exposure, metric and methods of the screen, and its file", async () => {
  await compare("&mode=crops&crop=4,6,10,8&ev=1.5&y=relmse");
  await page.waitForSelector(".crops canvas");
  await opened();
  const pdf = await saved("PDF");
  assert.deepEqual(pdf, { name: "figure.pdf", text: "%PDF" });
  assert.equal(mock.drawn.format, "pdf");
  const { spec } = mock.drawn;
  assert.equal(spec.scenes.length, 1);
  assert.deepEqual([spec.scenes[0].crops, spec.scenes[0].exposure], [[[4, 6, 10, 8]], 1.5]);
  assert.deepEqual(spec.methods.map((m) => m.jobs), [[job], [other]]);
  assert.ok(spec.methods.every((m) => m.name.length > 0 && m.name.length <= 60));
  assert.deepEqual([spec.metrics, spec.error_map], [["relmse"], null]);
  await saved("SVG");
  assert.equal(mock.drawn.format, "svg");
  const file = await saved("Save figure.json");
  assert.deepEqual(JSON.parse(file.text), spec);
  await screenshot(page, "paper-figure");
  assert.deepEqual(page.troubles, []);
});

test("of whole pictures and of an error; a refusal is told", async () => {
  await compare("&show=error-squared");
  await page.waitForSelector(".stage[data-shown='error-squared']");
  await opened();
  mock.refusal = "found 9 methods; allowed: at most 8";
  await button("PNG").click();
  await page.locator("dialog").getByText("allowed: at most 8").waitFor();
  assert.deepEqual([mock.drawn.spec.scenes[0].crops, mock.drawn.spec.error_map], [[], "mse"]);
  assert.deepEqual(page.troubles.filter((text) => !text.includes("status of 400")), []);
});

test("a click on a pixel shows its paths, as a table and from the side", async () => {
  await compare("");
  const tool = page.getByRole("button", { name: "Paths of a pixel" });
  assert.equal(await tool.getAttribute("aria-pressed"), "false");
  async function place(x, y) {
    await page.locator(stage).scrollIntoViewIfNeeded();
    const box = await page.locator(stage).boundingBox();
    return [box.x + ((x + 0.5) * box.width) / 40, box.y + ((y + 0.5) * box.height) / 30];
  }
  await page.mouse.click(...await place(3, 2));
  await frames(page);
  assert.equal(mock.traced, null, "clicks move the picture, unless asked otherwise");
  await tool.click();
  await page.mouse.click(...await place(7, 9));
  await page.getByRole("heading", { name: "Paths of pixel (7, 9)" }).waitFor();
  await page.locator(".viewer svg polyline").first().waitFor();
  assert.deepEqual([mock.traced.id, mock.traced.pixel], [job, [7, 9]]);
  assert.ok(mock.traced.samples >= 1 && mock.traced.samples <= 64);
  const rows = await page.locator(".viewer tbody tr").evaluateAll((all) =>
    all.map((row) => [...row.children].map((cell) => cell.textContent)));
  assert.deepEqual(rows[0].slice(0, 7), ["EDL", "75.0 %", "8.00, 4.00, 2.00", "2", "s 1, t 2", "0.500", "3"]);
  assert.match(rows[0][7], /D at 1\.00, 0, 0\.500, from the eye, density 0\.250 per area/);
  assert.match(rows[1][7], /L to 0, 1\.00, 0, from the eye, density 3\.00 per steradian/);
  // z is the smallest axis: x to the right and y up, from 0 to 4 in 616 pixels, in a margin of 12.
  const lines = await page.locator(".viewer svg polyline").evaluateAll((all) => all.map((l) => l.getAttribute("points")));
  assert.equal(lines.at(-1), "628.00,320.00 166.00,474.00 320.00,12.00", "the brightest is above the others");
  assert.ok(lines[0].startsWith("628.00,320.00 12.00,320.00 12.00,-"), lines[0]);
  await screenshot(page, "pixel-paths");

  mock.refusal = "found \"sppm\", which does not keep whole paths";
  await page.locator(stage).press("2");
  await page.mouse.move(...await place(1, 1));
  await page.locator(stage).press("p");
  await page.getByText("does not keep whole paths").waitFor();
  assert.deepEqual([mock.traced.id, mock.traced.pixel], [other, [1, 1]]);
  await tool.click();
  await page.getByRole("button", { name: "Paths of a pixel", pressed: false }).waitFor();
  assert.deepEqual(page.troubles.filter((text) => !text.includes("status of 400")), []);
});
