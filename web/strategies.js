// The contribution of each strategy to a job's picture, as a pyramid with a row per path length, and each distribution.
import { choice, h, keep, note, problem, replace, scroll, update } from "./dom.js";
import { number, significant, thin } from "./format.js";
import { exposed, lookOf, stripPainter } from "./paint.js";
import { reduced } from "./pixels.js";
import { exposureTools } from "./viewer_controls.js";

const sets = [{ key: "strategies", label: "weighted" }, { key: "strategies_unweighted", label: "before weighting" }];
const unweighted = sets[1].key;

/// The layers that are shown here: {name, set, text}, and of strategies {s, t, edges, merged}.
function partsOf(names) {
  return names.map((name) => {
    const [, set, of, s, t, merged] = /^(\w+)\.(s(\d+)t(\d+)(m?)$|.+)/.exec(name) ?? [];
    if (set === "distributions") return { name, set, text: of };
    return s && sets.some(({ key }) => key === set) && { name, set, s: Number(s), t: Number(t), merged: Boolean(merged),
      edges: Number(s) + Number(t) - (merged ? 2 : 1), text: `s${thin}${s} t${thin}${t}${merged ? " merged" : ""}` };
  }).filter(Boolean);
}

const edgesText = (n) => `${n} edge${n === 1 ? "" : "s"}`;

/// Strategies in rows by length, the first column, and columns by s; merging strategies on the right.
function pyramid(cells) {
  const lengths = [...new Set(cells.map((c) => c.edges))].sort((a, b) => a - b);
  const least = Math.min(...cells.map(({ s }) => s));
  const joined = Math.max(0, ...cells.filter((c) => !c.merged).map(({ s }) => s));
  const column = ({ s, merged }) => 1 + (merged ? joined + s - 1 : s) - least;
  const place = (element, row, column) => {
    Object.assign(element.style, { gridRow: row + 1, gridColumn: column + 1 });
    return element;
  };
  return scroll("Pyramid", h("div.pyramid",
    lengths.map((k, row) => place(h("span.muted", edgesText(k)), row, 0)),
    cells.map((c) => place(c.element, lengths.indexOf(c.edges), column(c)))));
}

/// The available sets, and the shown one.
function offered(parts, query) {
  const options = sets.filter(({ key }) => parts.some((p) => p.set === key));
  return { options, set: (options.find(({ key }) => key === query.get("strategies")) ?? options[0])?.key };
}

function cellOf(part, { width, height }, open) {
  const wide = window.innerWidth < 760 ? 92 : 132;
  const canvas = h("canvas", { width: wide, height: Math.round(wide * height / width) || 1 });
  const light = h("span");
  const label = `${part.text}${part.edges ? `, ${edgesText(part.edges)}` : ""}: show it in the viewer`;
  return { ...part, wide, canvas, light,
    element: h("button.cell", { type: "button", "aria-label": label, onclick: () => open(part.name) },
      canvas, h("span", part.text), light) };
}

const aboutText = (set, steps, others) => [
  set && "s vertices are sampled from the light, t from the eye.",
  steps.some((c) => c.merged) && "Merged: the last vertices of both subpaths are merged.",
  set === unweighted && "Each image estimates all light of its path length, with its mean below. Images in a row "
    + "agree, except for noise and paths that a strategy cannot sample.",
  (set !== unweighted || others.length > 0) && "In %: its share of the picture's light.",
  "All at one exposure; a click shows one in the viewer.",
].filter(Boolean).join(" ");

/// Reads the layers of cells one by one, keeps the drawn part of each, and writes its light beside it; returns the
/// `look` of the picture and the `shares` of techniques as text, or null once it is `over()`.
async function readCells(layers, cells, over) {
  const small = (image) => reduced(image, Math.floor(image.width / cells[0].wide / window.devicePixelRatio) || 1);
  const [picture] = await layers.read("");
  const whole = (await small(picture)).mean;
  const percent = (mean) => `${significant(100 * mean / whole)}${thin}%`;
  const light = { hit: 0, connected: 0, merged: 0 };
  for (const cell of cells) {
    const [layer] = await layers.read(cell.name);
    layers.forget(cell.name);
    const { image, mean } = await small(layer);
    if (over()) return null;
    cell.image = image;
    if (cell.edges) light[cell.merged ? "merged" : cell.s > 0 ? "connected" : "hit"] += mean;
    update(cell.light, cell.set === unweighted ? number(mean) : percent(mean));
  }
  const told = Object.entries(light).map(([name, mean]) => `${name} ${percent(mean)}`).join(", ");
  return { look: lookOf([picture]), shares: cells.some((c) => c.merged && c.set !== unweighted) && `${told}.` };
}

/// `show(layers)` takes those of a job, read once this is visible; calls `open(name)` for the layer that the user
/// selects. The choice is stored in `query`.
export function strategies(query, signal, open) {
  const paint = stripPainter(signal);
  const [title, tools, about, shares, say, body] = [h("h2"), h("div.tools"), note(), note(), h("div"), h("div")];
  const element = h("section", title, tools, about, shares, say, body);
  let layers = null;
  let parts = [];
  let cells = [];
  let look = null;  // of the picture itself
  let turn = 0;

  const stops = () => (query.has("stops-each") ? Number(query.get("stops-each")) || 0 : null);

  async function draw() {
    const { options, set } = offered(parts, query);
    update(tools,
      h("span", { hidden: options.length < 2 }, choice("Strategies", options, set, (key) => {
        keep(query, { strategies: key === unweighted && key });
        build();
      })),
      look && exposureTools(stops() ?? look.ev, (value) => {
        keep(query, { "stops-each": value !== null && String(value) });
        draw();
      }));
    if (look) await paint(cells.filter((c) => c.image), exposed(look, { ev: stops() }), window.devicePixelRatio);
  }

  async function load(mine) {
    const read = await readCells(layers, cells, () => turn !== mine || signal.aborted);
    if (read === null) return;
    look = read.look;
    update(shares, read.shares);
    await draw();
    if (turn === mine) body.ariaBusy = "false";
  }

  const seen = new IntersectionObserver(([entry]) => {
    if (!entry.isIntersecting || signal.aborted) return;
    seen.disconnect();
    const mine = turn;
    load(mine).catch((error) => { if (turn === mine && !signal.aborted) replace(say, problem(error.message)); });
  });
  signal.addEventListener("abort", () => seen.disconnect());

  /// One set of strategies, and the distributions.
  function build() {
    turn += 1;
    body.ariaBusy = "true";  // until its pictures are loaded, which may wait until they are visible
    const { set } = offered(parts, query);
    const [steps, others] = [set, "distributions"].map((of) =>
      parts.filter((p) => p.set === of).map((part) => cellOf(part, layers, open)));
    cells = [...steps, ...others];
    draw();
    update(title, set ? "Strategies" : "Resampling distributions");
    update(about, aboutText(set, steps, others));
    for (const part of [say, shares]) replace(part);
    replace(body, set && pyramid(steps), others.length > 0 && [set && h("h3", "Resampling distributions"),
      h("div.distributions", others.map((c) => c.element))]);
    seen.disconnect();
    seen.observe(element);
  }

  return {
    element,
    show(next) {
      layers = next;
      parts = partsOf(layers.names);
      element.hidden = parts.length === 0;
      if (parts.length > 0) build();
    },
  };
}
