// Saving a figure as a file.
import { h } from "./dom.js";

const enlarged = 3;  // pixels of the PNG for one of the SVG

async function pngOf(source, { width, height }) {
  const image = h("img", { src: source, width, height });
  await image.decode();
  const canvas = h("canvas", { width: enlarged * width, height: enlarged * height });
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve) => { canvas.toBlob(resolve, "image/png"); });
}

/// Gives every part of `svg` the colours that the page's names stand for now.
function resolveColours(svg) {
  svg.setAttribute("hidden", "");
  document.body.append(svg);
  for (const part of svg.querySelectorAll("[fill], [stroke]")) {
    const { fill, stroke } = getComputedStyle(part);
    for (const [name, value] of Object.entries({ fill, stroke })) part.setAttribute(name, value);
  }
  svg.remove();
  svg.removeAttribute("hidden");
}

/// Saves an SVG element as `name`, whose ending, svg or png, says how.
export async function saveFigure(svg, name) {
  resolveColours(svg);
  const text = new XMLSerializer().serializeToString(svg);
  const sources = [URL.createObjectURL(new Blob([text], { type: "image/svg+xml" }))];
  if (name.endsWith("png")) sources.push(URL.createObjectURL(await pngOf(sources[0], svg.viewBox.baseVal)));
  h("a", { href: sources.at(-1), download: name }).click();
  setTimeout(() => sources.forEach(URL.revokeObjectURL), 10_000);
}
