// Why a pixel has its value: its brightest paths, by `lacuna trace`, as a table and as a picture from the side.
import { getPaths } from "./api.js";
import { h, note, problem, replace, table } from "./dom.js";
import { curveColour, svg } from "./figure.js";
import { number, significant } from "./format.js";

const [wide, margin, samples] = [640, 12, 64];
const list = (values) => values.map((v) => significant(v)).join(", ");

/// The picture along the axis in which the scene is smallest. `bounds`: its lowest and its highest corner.
function sideView({ bounds: [low, high], paths }) {
  const size = low.map((v, k) => high[k] - v);
  const along = size.indexOf(Math.min(...size));
  // From above, z points down the page; else y points up.
  const [across, down, sign] = [[2, 1, -1], [0, 2, 1], [0, 1, -1]][along];
  const flat = (p) => [p[across], sign * p[down]];
  const far = Math.hypot(...size);
  const lines = paths.map(({ vertices }) => vertices.reduce((line, { position, direction }) =>
    [...line, position ?? line.at(-1).map((v, k) => v + far * direction[k])], []).map(flat));
  const places = [flat(low), flat(high), ...paths.flatMap(({ vertices }) => vertices)
    .filter(({ position }) => position).map(({ position }) => flat(position))];
  const [from, to] = [Math.min, Math.max].map((pick) => [0, 1].map((k) => pick(...places.map((p) => p[k]))));
  const scale = (wide - 2 * margin) / Math.max(to[0] - from[0], to[1] - from[1]);
  const at = (p) => p.map((v, k) => (margin + scale * (v - from[k])).toFixed(2));
  const [[x, y], [u, v]] = [flat(low), flat(high)].map(at);
  const [width, height] = [0, 1].map((k) => Math.ceil(2 * margin + scale * (to[k] - from[k])));
  const title = `The paths, seen along ${"xyz"[along]}, in which the scene is smallest, from the eye (large circle), in the box of the scene.`;
  return h("figure", svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": title },
    svg("rect", { x: Math.min(x, u), y: Math.min(y, v), width: Math.abs(u - x), height: Math.abs(v - y), fill: "none",
      stroke: "var(--muted)" }),
    ...lines.toReversed().map((line, i) => svg("g", { stroke: curveColour(lines.length - 1 - i), fill: "none" },
      svg("polyline", { points: line.map(at).join(" "), "stroke-width": 1.5 }),
      ...line.map(at).map(([cx, cy], k) => svg("circle", { cx, cy, r: k === 0 ? 6 : 2.5 }))))),
  h("figcaption", title));
}

function vertexLine({ position, direction, from, density }, letter) {
  const place = position ? `at ${list(position)}` : `to ${list(direction)}`;
  return `${letter} ${place}, from the ${from}${density > 0 ? `, density ${significant(density)} per ${position
    ? "area" : "steradian"}` : ""}`;
}

const pathRow = ({ letters, share, value, s, t, weight, iteration, vertices }, i) => {
  const swatch = h("span.swatch");
  swatch.style.background = curveColour(i);
  const text = vertices.map((vertex, k) => vertexLine(vertex, letters[k])).join("\n");
  return [[swatch, letters], `${(100 * share).toFixed(1)} %`, list(value), letters.length - 1, `s ${s}, t ${t}`,
    significant(weight), number(iteration),
    text ? h("details", h("summary", `${vertices.length} vertices`), h("pre", text)) : "the mean of several camera rays"];
};

let asked = 0;

/// Shows the paths of the pixel [x, y] of a job in `place`; the latest call wins.
export async function showPaths(place, { id, name, progress }, pixel) {
  asked += 1;
  const mine = asked;
  const show = (...content) => mine === asked
    && replace(place, h("h3", `Paths of pixel (${pixel.join(", ")}) of ${name}`), ...content);
  show(note("Being traced …"));
  try {
    const found = await getPaths(id, pixel, Math.min(samples, Math.max(1, progress?.iteration ?? 1)));
    show(note(`${number(found.count)} paths in the first ${number(found.samples)} iterations of seed ${found.seed}: mean `
      + `${list(found.mean)}. The brightest, from the eye (E) over surfaces (D diffuse, G glossy, S specular) to the `
      + "light (L):"),
    table(["Path", "Share", "Contribution R, G, B", "Edges", "Technique", "MIS weight", "Iteration", "Vertices"],
      found.paths.map(pathRow), true), found.paths.length > 0 && sideView(found));
  } catch (error) {
    show(problem(error.message));
  }
}
