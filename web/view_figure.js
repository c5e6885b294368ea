// The curves of one or more jobs as a single figure, to be saved or shown elsewhere.
import { isTerminal, poll } from "./api.js";
import { chosenAxes } from "./curve_panel.js";
import { h } from "./dom.js";
import { figureSvg } from "./figure_svg.js";
import { idsOf, names, readJob, reportedMetric } from "./series.js";

const everyMs = 5000;
const enlarged = 3;  // pixels of the PNG for one of the SVG

const blobOf = (element) =>
  new Blob([new XMLSerializer().serializeToString(element)], { type: "image/svg+xml" });

async function pngOf(element) {
  const source = URL.createObjectURL(blobOf(element));
  const { width, height } = element.viewBox.baseVal;
  const image = h("img", { src: source, width, height });
  await image.decode();
  const canvas = h("canvas", { width: enlarged * width, height: enlarged * height });
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(source);
  return new Promise((resolve) => { canvas.toBlob(resolve, "image/png"); });
}

function save(blob, name) {
  const source = URL.createObjectURL(blob);
  h("a", { href: source, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(source), 10_000);
}

export async function show(main, { params, query, signal }) {
  document.title = "Figure · Lacuna";
  const ids = params.id ? [params.id] : idsOf(query);
  const read = new Map();
  const place = h("figure", { className: "figure" });
  const drawn = () => place.querySelector("svg");
  const name = `lacuna-${ids.length === 1 ? ids[0] : `${ids.length}-jobs`}`;
  const button = (text, onclick) => h("button", { type: "button", className: "small", onclick }, text);
  const tools = h("div", { className: "tools" },
    button("Save as SVG", () => save(blobOf(drawn()), `${name}.svg`)),
    button("Save as PNG", async () => save(await pngOf(drawn()), `${name}.png`)),
    button("Leave the figure", () => { location.hash = location.hash.replace(/[?&]embed(=[^&]*)?(?=&|$)/, "")
      .replace(/^([^?&]*)&/, "$1?"); }));
  main.append(h("section", {}, place, tools));

  function draw() {
    const jobs = ids.map((id) => read.get(id));
    const labels = names(jobs);
    const series = jobs.map((job, i) => ({ name: labels[i], rows: job.rows }));
    const { x, y } = chosenAxes(query, series, reportedMetric(jobs));
    const figure = figureSvg(series, x, y);
    tools.hidden = figure === null;
    place.replaceChildren(figure ?? h("p", { className: "note" }, "No errors have been measured."));
  }

  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw, { signal });
  await poll(async () => {
    await Promise.all(ids.map(async (id) => read.set(id, await readJob(id, read.get(id), signal))));
    draw();
    return [...read.values()].some((job) => !isTerminal(job.state.state));
  }, everyMs, signal);
}
