// The controls of a viewer: keys, pointer and buttons.
import { button, choice, h, select, small } from "./dom.js";
import { errorKinds } from "./errors.js";
import { cropBetween, fitZoom, moved, movedCrop, pointAt, scaledCrop, zoomOf, zoomTo } from "./viewport.js";

/// The view (see viewport.js) of a viewer's state.
export const viewOf = ({ zoom, at: [x, y] }) => ({ zoom, x, y });
const grip = 12;  // CSS pixels on each side of the split line in which a drag moves it

/// Actions on a viewer that has content: {state, size(), seen, content, options, sources, change(values)}.
export function viewerActions(own) {
  const { state, change } = own;
  const view = () => [viewOf(state), own.size(), own.seen.box()];
  const setView = ({ zoom, x, y }) => change({ zoom, at: [x, y] });
  const isColour = () => own.content.look.look === "colour";
  const setExposure = (value) => change(isColour() ? { ev: value } : { stops: value ?? 0 });
  const setSplit = (at) => change({ split: Math.min(1, Math.max(0, at)) });
  return {
    change,
    setExposure,
    expose: (by) => setExposure(by + (isColour() ? state.ev ?? own.content.look.ev : state.stops)),
    zoomBy: (factor, u, v) => setView(zoomTo(...view(), zoomOf(...view()) * factor, u, v)),
    fit: () => setView({ zoom: null, x: 0.5, y: 0.5 }),
    oneToOne: () => setView(zoomTo(...view(), 1 / window.devicePixelRatio)),
    /// The action of a drag from (u, v), in CSS pixels: move the line, choose a crop, or move the picture.
    begin(u, v) {
      if (state.mode === "split" && Math.abs(u - state.split * own.seen.box().width) < grip) {
        return (at) => setSplit(at / own.seen.box().width);
      }
      if (state.mode === "crops") {
        const from = pointAt(...view(), u, v);
        return (...at) => change({ crop: cropBetween(from, pointAt(...view(), ...at), own.size()) });
      }
      let last = [u, v];
      return (...at) => {
        setView(moved(...view(), last[0] - at[0], last[1] - at[1]));
        last = at;
      };
    },
    /// Moves by a tenth of the frame, or of the crop; false if everything is visible already.
    move(right, down) {
      const [, size, box] = view();
      if (state.mode === "crops") change({ crop: movedCrop(state.crop, right, down, size) });
      else if (zoomOf(...view()) <= fitZoom(size, box)) return false;
      else setView(moved(...view(), 0.1 * right * box.width, 0.1 * down * box.height));
      return true;
    },
    /// Moves the line between two pictures, or resizes the crop, by a step.
    shift(step) {
      if (state.mode === "split") setSplit(state.split + 0.05 * step);
      if (state.mode === "crops") change({ crop: scaledCrop(state.crop, step, own.size()) });
    },
    cycle(by) {
      const { options } = own;
      const at = options.findIndex((o) => o.key === state.show);
      change({ show: options[(at + by + options.length) % options.length].key });
    },
    /// The mode in which a click shows the paths of a pixel.
    setTracing(tracing) {
      own.tracing = tracing;
      own.redraw();
    },
    /// Shows the paths of the pixel under a point, in CSS pixels, by default the pointer or the middle of the frame.
    trace(...at) {
      const box = own.seen.box();
      const [u, v] = at.length > 0 ? at : own.pointer ?? [box.width / 2, box.height / 2];
      const { x, y } = pointAt(...view(), u, v);
      const right = state.mode === "split" && u > state.split * box.width;
      own.showPaths(own.sources[right ? state.right : state.left], [Math.floor(x), Math.floor(y)]);
    },
    /// False if there is no such picture.
    pick(i) {
      if (own.sources.length < 2 || i >= own.sources.length) return false;
      change({ left: i });
      return true;
    },
  };
}

const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/// Handles a key; false if it has no meaning.
function press(key, actions) {
  const plain = {
    "+": () => actions.zoomBy(2),
    "=": () => actions.zoomBy(2),
    "-": () => actions.zoomBy(0.5),
    0: actions.fit,
    f: actions.fit,
    o: actions.oneToOne,
    e: () => actions.expose(0.5),
    E: () => actions.expose(-0.5),
    ",": () => actions.shift(-1),
    ".": () => actions.shift(1),
    "[": () => actions.cycle(-1),
    "]": () => actions.cycle(1),
    p: () => actions.trace(),
  };
  if (arrows[key]) return actions.move(...arrows[key]);
  if (/^[1-9]$/.test(key)) return actions.pick(Number(key) - 1);
  return key in plain && plain[key]();
}

/// Keys, wheel and pointer over a viewer's frame. The wheel zooms only with the focus, and otherwise scrolls the page.
export function listenTo(own) {
  const { actions, seen: { frame } } = own;
  let drag = null;
  const at = (event) => {
    const box = frame.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const on = (name, act, options) => frame.addEventListener(name, (event) => own.content && act(event), options);
  const hover = (point) => {
    own.pointer = point;
    own.redraw();
  };
  new ResizeObserver(own.redraw).observe(frame);
  on("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (press(event.key, actions) !== false) event.preventDefault();
  });
  on("pointerdown", (event) => {
    if (event.button !== 0) return;
    if (own.tracing) return actions.trace(...at(event));
    drag = actions.begin(...at(event));
    frame.setPointerCapture(event.pointerId);
  });
  on("pointermove", (event) => {
    hover(at(event));
    drag?.(...at(event));
  });
  for (const name of ["pointerup", "pointercancel"]) on(name, () => { drag = null; });
  on("pointerleave", () => hover(null));
  on("wheel", (event) => {
    if (document.activeElement !== frame) return;
    event.preventDefault();
    actions.zoomBy(event.deltaY < 0 ? 1.25 : 0.8, ...at(event));
  }, { passive: false });
}

/// Exposure in stops, and a reset to the automatic one.
export const exposureTools = (value, setExposure) => h("span.exposure.tools",
  h("label", "EV ", h("input", { type: "number", step: "0.1", "aria-label": "Exposure in stops",
    value: Number(value.toFixed(2)),
    oninput: ({ target }) => target.value !== "" && setExposure(Number(target.value)) })),
  small("Auto", () => setExposure(null), "Automatic exposure"));

/// The choice of layer, exposure, zoom and clicks. `stops` null: the layer has no exposure.
export const viewerTools = (actions, { options, chosen, stops, zoom, tracing }) => [
  choice("Show", options, chosen, (show) => actions.change({ show })),
  h("span", { hidden: stops === null }, stops !== null && exposureTools(stops, actions.setExposure)),
  h("span.tools",
    small("−", () => actions.zoomBy(0.5), "Zoom out"), small("+", () => actions.zoomBy(2), "Zoom in"),
    small("Fit", actions.fit, "Show the whole picture"),
    small("1:1", actions.oneToOne, "One picture pixel per screen pixel"),
    h("output.muted", `${Number((100 * zoom).toPrecision(3))} %`)),
  button("Paths of a pixel", () => actions.setTracing(!tracing), { className: "small", "aria-pressed": String(tracing),
    title: "Then a click on a pixel shows its brightest paths" }),
  small("Keys", () => document.getElementById("keys").click()),
];

export const modes = { one: "one at a time", split: "split", difference: "difference", crops: "crops side by side" };

/// The controls for several pictures: one at a time, two split by a line, their difference, or crops.
export function modeTools(change, { mode, left, right, by }, labels) {
  const options = labels.map((label, i) => ({ key: String(i), label: `${i + 1} ${label}` }));
  const ways = Object.entries(modes).map(([key, label]) => ({ key, label }));
  const second = { split: "left of", difference: "subtracted from" }[mode];
  return [
    choice("Pictures", ways, mode, (value) => change({ mode: value })),
    select(options, String(left), (value) => change({ left: Number(value) }), { "aria-label": "First picture" }),
    second && [h("span.muted", second),
      select(options, String(right), (value) => change({ right: Number(value) }), { "aria-label": "Second picture" })],
    mode === "difference" && choice("by", errorKinds, by, (value) => change({ by: value })),
  ];
}
