// The page in Chromium with the service's 10,000 jobs, and with a comparison of 20:
//     node tests/bench/page.mjs
// prints the figures below, each the least of some rounds, because what else the machine does only adds
// to them; ends with 1 if one is missed. A task is what keeps the page from answering; the browser tells
// of those above 50 ms, so 0 means that there was none.
import { launch, longestTask, newPage } from "../web/browser.mjs";
import { realFolders, startReal } from "../server/real_service.mjs";
import { bench, figure } from "./figures.mjs";
import { fill, many } from "./many_jobs.mjs";

const rounds = 3;
const compared = 20;
const noticed = 100;  // ms: a shorter pause is not seen
const spec = { scene: "cornell.glb", resolution: [256, 256], reference: "auto", reference_iterations: 32,
  layers: ["variance"], budget: { iterations: 16 } };

const least = new Map();

/// Keeps the least of what was measured under this name, in milliseconds.
function measured(name, value, allowed) {
  least.set(name, { value: Math.min(value, least.get(name)?.value ?? Infinity), allowed });
}

const pause = async (page, name) => measured(`longest task ${name}`, await longestTask(page, true), noticed);

/// Finished jobs with curves and layers, and `many` copies of the first: their ids.
async function makeJobs(places) {
  const service = await startReal(places);
  const ids = [];
  for (let i = 0; i < compared; i += 1) ids.push(await service.post(`measured ${i + 1}`, { ...spec, seed: i + 1 }));
  for (const id of ids) await service.reaches(id, "done", 600_000);
  await service.stop();
  fill(places.data, service.folder(ids[0]), { more: ["image.png"] });
  return ids;
}

const rows = (page, first) => page.waitForFunction((text) => document.querySelectorAll("tr[data-job]").length === 100
  && document.querySelector(".pager output").textContent.startsWith(text), `${first}–`);

/// Shows an address, waits for what it should show; gives the milliseconds from the start of its navigation.
async function timed(page, address, shown) {
  await page.goto("about:blank");
  const begin = performance.now();
  await page.goto(address);
  await shown();
  return performance.now() - begin;
}

async function list(page, service) {
  measured(`first 100 rows of ${many}`, await timed(page, service.url, () => rows(page, 1)), 1000);
  await page.waitForFunction(() => document.querySelectorAll(".thumb img").length > 0);
  await pause(page, "until they and their pictures are seen");
  for (let i = 0; i < 40; i += 1) await page.mouse.wheel(0, 200);
  await pause(page, "while scrolling through them");
  for (let i = 1; i <= 5; i += 1) {
    await page.getByRole("button", { name: "Older" }).click();
    await rows(page, 1 + 100 * i);
  }
  await pause(page, "while turning five pages");
  await page.locator("input[type=search]").pressSequentially("measured 2", { delay: 100 });
  await page.waitForFunction((text) => document.querySelector("main > .tools output").textContent === text,
    `2 of ${many + compared}`);
  await pause(page, "while typing a filter");
}

async function comparison(page, service, ids) {
  const address = new URL(`/#/compare?jobs=${ids.join()}`, service.url).href;
  const curves = () => page.waitForSelector(`.plot[data-curves='${compared}'] svg`);
  measured(`${compared} curves over one another`, await timed(page, address, curves), 1000);
  await page.waitForSelector(".stage[data-shown]");
  await pause(page, "until the pictures are seen");
  await page.getByLabel("against", { exact: true }).selectOption("iteration");
  await pause(page, "for another axis");
  await page.locator(".stage").focus();
  for (const key of ["2", "3", "4"]) await page.keyboard.press(key);
  await page.waitForSelector(".stage[aria-busy=false]");
  await pause(page, "while flipping pictures");
  await page.getByLabel("Show", { exact: true }).selectOption("error-relative");
  await page.waitForSelector(".stage[data-shown=error-relative]");
  await pause(page, `for ${compared} pictures of errors`);
  await page.getByLabel("Pictures", { exact: true }).selectOption("crops");
  await page.waitForFunction((n) => document.querySelectorAll(".crops canvas[style]").length === n, compared);
  await pause(page, `for ${compared} crops`);
}

await bench(async (test) => {
  const places = realFolders(test);
  const ids = await makeJobs(places);
  const service = await startReal(places);
  const browser = await launch();
  try {
    for (let i = 0; i < rounds; i += 1) {
      const page = await newPage(browser);
      await list(page, service);
      await comparison(page, service, ids);
      await page.context().close();
    }
  } finally {
    await browser.close();
  }
  for (const [name, { value, allowed }] of least) figure(name, value, "ms", allowed);
});
