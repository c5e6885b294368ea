// The viewer of pictures of numbers: its state, stored in the URL, the pictures that it requires, and drawing them.
import { h, keep, problem, update } from "./dom.js";
import { errorKinds, errorOf, kindOf } from "./errors.js";
import { number, significant, words } from "./format.js";
import { metrics } from "./job_tables.js";
import { exposed, lookOf, painter } from "./paint.js";
import { valuesAt } from "./pixels.js";
import { listenTo, modes, modeTools, viewerActions, viewerTools, viewOf } from "./viewer_controls.js";
import { colourBar, cropStrip, printPixels, stage } from "./viewer_parts.js";
import { pointAt, settleCrop, zoomOf } from "./viewport.js";

/// The message if viewer() returns null.
export const noViewer = "This browser has no WebGL 2: the tone-mapped image.png is shown instead of the values.";
const finite = (text) => (text?.trim() && Number.isFinite(Number(text)) ? Number(text) : null);
const share = (text) => Math.min(1, Math.max(0, finite(text) ?? 0.5));
const place = (text, otherwise = 0) => Math.max(0, Math.trunc(finite(text) ?? otherwise));
const short = (value) => String(Number(value.toPrecision(5)));

/// "x,y,w,h", in pixels; null if that is not a rectangle.
function rectangle(text) {
  const [x, y, w, h] = (text ?? "").split(",").map((part) => place(part));
  return w > 0 && h > 0 ? { x, y, w, h } : null;
}

/// A viewer's state: how each part is parsed from the URL, and written to it unless it has its default.
const fields = {
  /// A layer or an error, see choices().
  show: [(text) => text ?? "", ({ show }) => show],
  /// Exposure in stops, of colours and of false colours.
  ev: [finite, ({ ev }) => ev !== null && short(ev)],
  stops: [(text) => finite(text) ?? 0, ({ stops }) => stops !== 0 && short(stops)],
  /// The visible part, see viewport.js.
  zoom: [(text) => (finite(text) > 0 ? finite(text) : null), ({ zoom }) => zoom !== null && short(zoom)],
  at: [(text) => [0, 1].map((i) => share(text?.split(",")[i])),
    ({ zoom, at }) => zoom !== null && at.map(short).join()],
  /// For several pictures: which ones, the position of the split, the measure of the difference, and the crop.
  mode: [(text) => (Object.hasOwn(modes, text) ? text : "one"), ({ mode }) => mode !== "one" && mode],
  left: [place, ({ left }) => left],
  right: [(text) => place(text, 1), ({ mode, right }) => mode !== "one" && right !== 1 && String(right)],
  split: [share, ({ mode, split }) => mode === "split" && split !== 0.5 && short(split)],
  by: [(text) => text ?? "signed", ({ mode, by }) => mode === "difference" && by !== "signed" && by],
  crop: [rectangle, ({ mode, crop }) => mode === "crops" && crop && Object.values(crop).join()],
};

const reference = "reference";
const errors = "error-";

/// The choices available for all `sources`: {key, label, group}. The picture itself has the key "".
function choices(sources) {
  const shared = sources[0].layers.names.filter((name) => sources.every((s) => s.layers.names.includes(name)));
  const layers = shared.map((key) => {
    const [group, ...name] = key.split(".");  // "strategies.s2t3"
    return { key, label: name.join(".") || key || "picture", group: name.length > 0 ? words(group) : "Layers" };
  });
  const kinds = shared.includes(reference) ? errorKinds : [];
  return [...layers,
    ...kinds.map(({ key, label }) => ({ key: errors + key, label, group: "Error against the reference" }))];
}

/// The image of the selected layer or error, and the named images that it is computed from.
async function pictureOf({ layers }, key) {
  const kind = key.startsWith(errors) && kindOf(key.slice(errors.length))?.key;
  if (!kind) return { picture: (await layers.read(key))[0], from: [] };
  const [x, r] = await layers.read("", reference);
  return { picture: await errorOf(x, r, kind), from: [["x", x], ["r", r]] };
}

/// Restricts `state` to what `sources` can show; returns their choices.
function settle(state, sources) {
  const options = choices(sources);
  if (!options.some((o) => o.key === state.show)) state.show = options[0].key;
  state.left = Math.min(state.left, sources.length - 1);
  state.right = Math.min(state.right, Math.max(1, sources.length - 1));
  if (sources.length < 2) state.mode = "one";
  if (state.mode === "crops") state.crop = settleCrop(state.crop, sources[0].layers);
  return options;
}

/// {images, shown, look, details}: the required pictures (the first, which sets the exposure, and all that share a
/// range); the shown one; their look; and others, with names, whose values are printed with it.
async function contentOf(state, sources) {
  const read = (i) => pictureOf(sources[i], state.show);
  const first = await read(0);
  const all = state.mode === "crops" || first.picture.channels.length === 1;
  const found = await Promise.all(sources.map((_, i) =>
    (i === 0 ? first : all || i === state.left || (i === state.right && state.mode !== "one") ? read(i) : null)));
  const images = found.map((f) => f?.picture);
  const [left, right] = [images[state.left], images[state.right]];
  if (state.mode !== "difference") {
    return { images, shown: left, look: lookOf(images.filter(Boolean)),
      details: state.mode === "split" ? [] : found[state.left].from };
  }
  const shown = await errorOf(right, left, (kindOf(state.by) ?? kindOf("signed")).key);
  return { images, shown, look: lookOf([shown]), details: [["x", right], ["r", left]] };
}

/// The parts of the frame from left to right: one picture, or two beside the line.
const partsOf = ({ mode, left, right, split }, { images, shown }) => (mode === "split"
  ? [{ image: images[left], from: 0, to: split }, { image: images[right], from: split, to: 1 }]
  : [{ image: shown, from: 0, to: 1 }]);

/// "R 0.123  G 0.2  B 0.3"
function valueText(image, x, y) {
  const names = image.channels.length > 1 ? image.channels.map((name) => `${name} `) : [""];
  return valuesAt(image, x, y).map((v, c) => names[c] + (Number.isFinite(v) ? significant(v, 4) : v)).join("  ");
}

/// A pixel's values, and a line for each of the details.
function pixelText(image, details, x, y) {
  if (valuesAt(image, x, y) === null) return "outside";
  return [`(${x}, ${y})  ${valueText(image, x, y)}`,
    ...details.map(([name, of]) => `${name}: ${valueText(of, x, y)}`)].join("\n");
}

/// The title of the colour bar, with the mean, which is the error in the curve.
function barTitle({ kind: key, mean }, layer) {
  if (!key) return layer;
  const kind = kindOf(key);
  const metric = metrics.find((m) => m.key === kind.metric);
  return `${kind.label}, ${kind.formula}; mean ${number(mean)}${metric ? ` (${metric.label})` : ""}`;
}

/// Draws `own` (see viewer) into its elements.
function drawAll(own) {
  const { state, seen, content, sources, actions } = own;
  const ratio = window.devicePixelRatio;
  const box = seen.box();
  const size = own.size();
  seen.fitCanvases(box, ratio);
  const view = viewOf(state);
  const zoom = zoomOf(view, size, box);
  const corner = pointAt(view, size, box, 0, 0);
  const look = exposed(content.look, state);
  const parts = partsOf(state, content);
  const imageAt = (u) => (parts.find((p) => u < p.to * box.width) ?? parts.at(-1)).image;
  own.paint.draw(parts.map((part) => ({ ...part, ...look })), { ...corner, pace: 1 / (zoom * ratio) });
  printPixels(seen.text, box, ratio, { corner, zoom, size, imageAt });
  seen.mark(state, corner, zoom);
  own.crops.show(state, sources, content.images, look, ratio);
  own.bar.show(look, barTitle(content.shown, state.show));

  // Without a pointer, reads the pixel in the middle.
  const [u, v] = own.pointer ?? [box.width / 2, box.height / 2];
  const at = pointAt(view, size, box, u, v);
  update(own.readout, (own.pointer ? "" : "middle ")
    + pixelText(imageAt(u), content.details, Math.floor(at.x), Math.floor(at.y)));

  const stops = { colour: state.ev ?? look.ev, direction: null, false: state.stops }[look.look];
  const { options, tracing } = own;
  update(own.tools, viewerTools(actions, { options, chosen: state.show, zoom: zoom * ratio, stops, tracing }));
  update(own.modes, sources.length > 1 && modeTools(actions.change, state, sources.map((s) => s.name)));
  seen.frame.classList.toggle("tracing", own.tracing);
  seen.frame.classList.toggle("zoomed", state.zoom !== null || state.mode === "crops");
  seen.frame.dataset.shown = state.show || "picture";
  seen.frame.dataset.zoom = Number(zoom.toPrecision(4));
}

/// A viewer whose state is in `query` (URLSearchParams) and the URL; null without WebGL 2. `show(sources)` takes
/// [{id, name, layers, seconds, error}] (see openLayers; render time, error as text) of one size, shown alike;
/// `open(key)` selects a layer of them and scrolls to the viewer.
export function viewer(query, signal) {
  const seen = stage();
  const state = Object.fromEntries(Object.entries(fields).map(([key, [read]]) => [key, read(query.get(key))]));
  const trouble = h("div");
  const say = (text) => update(trouble, text && problem(text));
  let pending = false;
  let turn = 0;

  function redraw() {
    if (pending) return;
    pending = true;
    requestAnimationFrame(() => {
      pending = false;
      if (!own.content || signal.aborted || !seen.frame.isConnected) return;
      try {
        drawAll(own);
      } catch (error) {
        say(error.message);
      }
    });
  }

  const own = {
    state, seen, redraw, sources: [], options: [], content: null, pointer: null, tracing: false,
    bar: colourBar(), crops: cropStrip(signal), readout: h("p.readout"), tools: h("div.tools"), modes: h("div.tools"),
    paths: h("div"),
    size: () => own.sources[0].layers,
    showPaths: async (...of) => (await import("./pixel_paths.js")).showPaths(own.paths, ...of),
    change(values) {
      Object.assign(state, values);
      keep(query, Object.fromEntries(Object.entries(fields).map(([key, [, write]]) => [key, write(state)])));
      if (["show", "mode", "left", "right", "by"].some((key) => key in values)) refresh();
      else redraw();
    },
  };
  own.paint = painter(seen.canvas, redraw);
  if (!own.paint) return null;
  own.actions = viewerActions(own);

  /// The previous pictures stay until the requested ones are loaded.
  async function refresh() {
    turn += 1;
    const mine = turn;
    own.options = settle(state, own.sources);
    seen.frame.ariaBusy = "true";
    try {
      const content = await contentOf(state, own.sources);
      if (mine !== turn || signal.aborted) return;
      own.content = content;
      say("");
      redraw();
    } catch (error) {
      if (mine === turn && !signal.aborted) say(error.message);
    }
    if (mine === turn) seen.frame.ariaBusy = "false";
  }

  listenTo(own);
  signal.addEventListener("abort", () => own.paint.release());

  return {
    element: h("figure.viewer",
      own.modes, seen.frame, own.bar.element, own.readout, trouble, own.tools, own.crops.element, own.paths),
    show(sources) {
      own.sources = sources;
      seen.setSize(own.size());
      const names = sources.map((s) => s.name).join(" and ");
      seen.frame.ariaLabel = `Picture of ${names}. The question mark lists its keys.`;
      return refresh();
    },
    /// What is on the screen as parts of a figure's file (docs/figures.md): {scene: {crops, exposure}, error_map}.
    screen() {
      const look = own.content?.look;
      const ev = look?.look === "colour" ? state.ev ?? look.ev : state.ev;
      return {
        scene: { crops: state.mode === "crops" ? [Object.values(state.crop)] : [], exposure: ev },
        error_map: (state.show.startsWith(errors) && kindOf(state.show.slice(errors.length)).metric) || null,
      };
    },
    open(key) {
      own.change({ show: key });
      seen.frame.focus();
    },
  };
}
