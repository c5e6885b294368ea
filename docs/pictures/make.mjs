// Renders the pictures of docs/ and of the page: `./dev pictures` runs it after first_page.py; four minutes on two cores.
// It starts the service, renders the jobs below, and takes pictures of the page, and of pages that it
// composes itself, in headless Chromium. It prints the errors that stand below the pictures. With --again it
// takes the pictures of the jobs that it rendered last.
import { mkdirSync, rmSync } from "node:fs";
import { fileURLToPath } from "node:url";

import { launch, newPage, visit } from "../../tests/web/browser.mjs";
import { startReal, ownScenes } from "../../tests/server/real_service.mjs";

const here = (name) => fileURLToPath(new URL(name, import.meta.url));
const data = here("../../build/pictures");  // references and the cache stay there
const again = process.argv.includes("--again");

const seconds = 10;
const scene = { scene: "ajar.glb", camera: "room", resolution: [320, 180] };
const max_depth = 8;
const methods = [
  ["path", { type: "path", max_depth }],
  ["path, guide skeleton", { type: "path", max_depth,
    guide: { type: "skeleton", strength: "auto", probability: "auto" } }],
  ["path, guide sd_tree", { type: "path", max_depth, guide: { type: "sd_tree" } }],
  ["bdpt, paired", { type: "bdpt", max_depth, connections: { type: "paired" } }],
  ["bdpt, skeleton", { type: "bdpt", max_depth, connections: { type: "skeleton" } }],
  ["many_lights, probabilistic", { type: "many_lights", max_depth, light_paths: 1000,
    visibility: { type: "probabilistic" } }],
];
const compared = ["path", "bdpt, paired", "bdpt, skeleton"];
const views = [
  ["filtered_mapping", "node of the filtered skeleton"],
  ["region_labels", "region of the opening forest"],
  ["visibility_clusters", "visibility cluster"],
];

/// Posts a job, waits for its end; gives {id, name, mse, relmse, iterations} of the last row of its curve.
async function render(service, name, job) {
  const before = again && (await service.json("/api/jobs")).jobs.find((j) => j.label === name);
  const id = before ? before.id : await service.post(name, { ...scene, ...job });
  for (let state = ""; state !== "done"; ) {
    await new Promise((resolve) => { setTimeout(resolve, 300); });
    ({ state: { state } } = await service.json(`/api/jobs/${id}`));
    if (["failed", "cancelled"].includes(state)) throw new Error(`${name}: ${state}`);
  }
  const [head, ...rows] = (await (await service.fetch(`/api/jobs/${id}/files/curve.csv`)).text()).trim().split("\n");
  const last = rows.at(-1).split(",");
  const value = (key) => Number(last[head.split(",").indexOf(key)]);
  return { id, name, mse: value("mse"), relmse: value("relmse"), iterations: value("iteration") };
}

/// Draws figures side by side, `columns` in a row, each {id, layer, lines, crop}, all of one exposure (that of
/// the reference of the first) unless `own`; on a page of the service, whose modules read the layers.
const compose = (page, figures, columns, own) => page.evaluate(async ([list, wide, preview]) => {
  const { openLayers } = await import("/layers.js");
  const code = (v) => 255 * (v <= 0 ? 0 : v <= 0.0031308 ? 12.92 * v : 1.055 * Math.min(1, v) ** (1 / 2.4) - 0.055);
  const grid = document.createElement("div");
  grid.id = "figures";
  grid.style = `display: inline-grid; grid-template-columns: repeat(${wide}, auto); gap: 12px; padding: 12px;
    background: white; color: black; font: 15px sans-serif; position: absolute; left: 0; top: 0`;
  let exposure = null;
  for (const { id, layer, lines, crop } of list) {
    const canvas = document.createElement("canvas");
    const figure = document.createElement("figure");
    figure.style = "margin: 0";
    if (preview) {
      const image = new Image();
      image.src = `/api/jobs/${id}/files/image.png`;
      await image.decode();
      [canvas.width, canvas.height] = [image.width, image.height];
      canvas.getContext("2d").drawImage(image, 0, 0);
    } else {
      const layers = await openLayers(id);
      const [reference, picture] = await layers.read("reference", layer);
      const linear = ({ data: values, scale }) => Float32Array.from(values, (v) => v * scale);
      const rgb = linear(picture);
      if (exposure === null) {
        const truth = linear(reference);
        const luminances = new Float32Array(truth.length / 3).map((_, i) =>
          0.2126 * truth[3 * i] + 0.7152 * truth[3 * i + 1] + 0.0722 * truth[3 * i + 2]).sort();
        exposure = 0.8 / luminances[Math.floor(0.95 * luminances.length)];
      }
      const [left, top, width, height, zoom] = crop ?? [0, 0, layers.width, layers.height, 1];
      [canvas.width, canvas.height] = [width * zoom, height * zoom];
      const context = canvas.getContext("2d");
      const image = context.createImageData(canvas.width, canvas.height);
      for (let y = 0; y < canvas.height; y += 1) {
        for (let x = 0; x < canvas.width; x += 1) {
          const from = (top + Math.floor(y / zoom)) * layers.width + left + Math.floor(x / zoom);
          const to = 4 * (y * canvas.width + x);
          for (let c = 0; c < 3; c += 1) image.data[to + c] = code(rgb[3 * from + c] * exposure);
          image.data[to + 3] = 255;
        }
      }
      context.putImageData(image, 0, 0);
    }
    canvas.style = "display: block; margin-bottom: 6px";
    const caption = document.createElement("figcaption");
    caption.style = "color: black; font: 15px/20px sans-serif";
    lines.forEach((line, i) => {
      const element = document.createElement(i === 0 ? "b" : "span");
      element.style = "display: block";
      element.textContent = line;
      caption.append(element);
    });
    figure.append(canvas, caption);
    grid.append(figure);
  }
  document.body.replaceChildren(grid);
}, [figures, columns, own]);

/// As visit(); what was composed before is gone, also where the address differs only behind its #.
async function show(page, address) {
  await page.goto("about:blank");
  await visit(page, address);
}

async function save(page, selector, name, quality) {
  const target = selector === null ? page : page.locator(selector);
  await target.screenshot({ path: here(name), type: "jpeg", quality });
}

const text = (value) => value.toPrecision(2);
const lines = ({ name, mse, relmse, iterations }) =>
  [name, `MSE ${text(mse)}, relMSE ${text(relmse)}`, `${iterations} iterations in ${seconds} CPU s`];

mkdirSync(data, { recursive: true });
if (!again) rmSync(`${data}/jobs`, { recursive: true, force: true });
const service = await startReal({ data, scenes: ownScenes, services: [] });
const browser = await launch();
try {
  const done = [];
  for (const [name, integrator] of methods) {
    const job = await render(service, name, { integrator, budget: { cpu_seconds: seconds }, exclusive: true,
      reference: "auto", reference_iterations: 400 });
    console.log(lines(job).join("; "));
    done.push(job);
  }
  const spaces = [];
  for (const [show, name] of views) {
    spaces.push(await render(service, name, { integrator: { type: "inspect", show }, budget: { iterations: 16 } }));
  }
  const page = await newPage(browser, { viewport: { width: 1280, height: 880 }, colorScheme: "light" });

  const chosen = compared.map((name) => done.find((job) => job.name === name));
  const crop = [150, 62, 96, 72, 3];
  await show(page, service.url);
  await compose(page, [...done.map((job) => ({ id: job.id, layer: "", crop, lines: lines(job) })),
    { id: done[0].id, layer: "reference", crop, lines: ["reference", "bdpt, paired, 400 iterations"] }], 4, false);
  await save(page, "#figures", "methods.jpg", 85);

  await show(page, service.url);
  await compose(page, spaces.map(({ id, name }) => ({ id, lines: [name] })), 3, true);
  await save(page, "#figures", "space.jpg", 88);

  await show(page, `${service.url}#/job/${chosen[2].id}?x=cpu_seconds`);
  await page.waitForSelector(".stage[data-shown]");
  await page.waitForSelector(".plot svg");
  await save(page, null, "job.jpg", 85);

  await show(page, `${service.url}#/compare?jobs=${chosen.map(({ id }) => id).join()}&x=cpu_seconds&y=relmse`);
  await page.waitForSelector(".stage[data-shown]");
  await page.waitForSelector(".plot[data-curves='3'] svg");
  await save(page, null, "compare.jpg", 85);
} finally {
  await browser.close();
  await service.stop();
}
