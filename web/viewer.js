// The viewer of pictures of numbers: it keeps the state, reads what the state asks for, and draws.
import { colourBar } from "./colour_bar.js";
import { cropStrip } from "./crop_strip.js";
import { h, remember, setText } from "./dom.js";
import { painter } from "./gl_draw.js";
import { exposed } from "./look.js";
import { printPixels } from "./pixel_text.js";
import { viewerActions } from "./viewer_actions.js";
import { barTitle, contentOf, partsOf, pixelText, settle } from "./viewer_content.js";
import { handleKeys, handlePointer } from "./viewer_input.js";
import { modeTools } from "./viewer_modes.js";
import { stage } from "./viewer_stage.js";
import { readState, writeState } from "./viewer_state.js";
import { viewerTools } from "./viewer_tools.js";
import { pointAt, zoomOf } from "./viewport.js";

/// What is said where viewer() gives null.
export const noViewer = "This browser offers no WebGL 2: image.png is shown, tone-mapped, instead of the values.";

const contentKeys = ["show", "mode", "left", "right", "by"];
const ratio = () => window.devicePixelRatio;

/// Draws `own` (see viewer) into its elements.
function drawAll(own) {
  const { state, seen, content } = own;
  const box = seen.box();
  const size = own.size();
  seen.fitCanvases(box, ratio());
  const zoom = zoomOf(state.view, size, box);
  const corner = pointAt(state.view, size, box, 0, 0);
  const look = exposed(content.look, state);
  const parts = partsOf(state, content);
  const imageAt = (u) => (parts.find((p) => u < p.to * box.width) ?? parts.at(-1)).image;
  own.paint.draw(parts.map((part) => ({ ...part, ...look })), { ...corner, pace: 1 / (zoom * ratio()) });
  printPixels(seen.text, box, ratio(), { corner, zoom, size, imageAt });
  seen.mark(state, corner, zoom);
  own.crops.show(state, own.sources, content.images, look, ratio());
  own.bar.show(look, barTitle(content.shown, state.show));

  // Without a pointer, the pixel in the middle is read.
  const [u, v] = own.pointer ? [own.pointer.u, own.pointer.v] : [box.width / 2, box.height / 2];
  const at = pointAt(state.view, size, box, u, v);
  setText(own.readout, (own.pointer ? "" : "middle ")
    + pixelText(imageAt(u), content.details, Math.floor(at.x), Math.floor(at.y)));

  const stops = { colour: state.ev ?? look.ev, direction: null, false: state.stops }[look.look];
  own.tools.show({ options: own.options, chosen: state.show, zoom: zoom * ratio(), stops });
  own.modes.show(state, own.sources.map((s) => s.name));
  seen.frame.classList.toggle("zoomed", state.view.zoom !== null || state.mode === "crops");
  seen.frame.dataset.shown = state.show || "picture";
  seen.frame.dataset.zoom = Number(zoom.toPrecision(4));
}

function listen(own, actions, signal) {
  handleKeys(own.seen.frame, actions);
  handlePointer(own.seen.frame, {
    ...actions,
    hover(point) {
      own.pointer = point;
      own.redraw();
    },
  });
  const watch = new ResizeObserver(own.redraw);
  watch.observe(own.seen.frame);
  signal.addEventListener("abort", () => {
    watch.disconnect();
    own.paint.release();
  });
}

/// A viewer whose state is in `query` (URLSearchParams), and in the address with it.
/// `show(sources)` takes [{name, layers, seconds, error}] (see layers.js; how long was rendered and what
/// the error is, in words) of one size, all shown alike; `open(key)` chooses what of them (see shown.js), and
/// takes the reader there. null: there is no WebGL 2 here.
export function viewer(query, signal) {
  const seen = stage();
  const state = readState(query);
  const problem = h("p.problem", { role: "alert", hidden: true });
  let pending = false;
  let turn = 0;

  function say(text) {
    problem.hidden = text === "";
    setText(problem, text);
  }

  const own = {
    state, seen, sources: [], options: [], content: null, pointer: null,
    bar: colourBar(),
    crops: cropStrip(signal),
    readout: h("p.readout"),
    size: () => own.sources[0].layers,
    redraw() {
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
    },
  };
  own.paint = painter(seen.canvas, own.redraw);
  if (!own.paint) return null;

  /// What was drawn stays until what is asked for is there.
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
      own.redraw();
    } catch (error) {
      if (mine === turn && !signal.aborted) say(error.message);
    }
    if (mine === turn) seen.frame.ariaBusy = "false";
  }

  const actions = viewerActions(own, (values) => {
    Object.assign(state, values);
    writeState(state, query);
    remember(query);
    if (contentKeys.some((key) => key in values)) refresh();
    else own.redraw();
  });
  own.tools = viewerTools(actions);
  own.modes = modeTools(actions.change);
  listen(own, actions, signal);

  return {
    element: h("figure.viewer", own.modes.element, seen.frame, own.bar.element,
      own.readout, problem, own.tools.element, own.crops.element),
    show(sources) {
      own.sources = sources;
      seen.setSize(own.size());
      seen.frame.ariaLabel = `Picture of ${sources.map((s) => s.name).join(" and ")}. The question mark lists its keys.`;
      return refresh();
    },
    open(key) {
      actions.choose(key);
      seen.frame.focus();
    },
  };
}
