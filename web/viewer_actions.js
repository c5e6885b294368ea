// What a reader can do to a viewer, whether by key, pointer or button.
import { fitZoom, moved, zoomOf, zoomTo } from "./viewport.js";

const grip = 12;  // CSS pixels on each side of the split line that take hold of it

/// Actions on `own`: {state, size(), box(), ratio(), look(), options(), sources(), change(values)};
/// look() is null until something is drawn, and until then nothing moves.
export function viewerActions(own) {
  const { state, change } = own;
  const view = () => [state.view, own.size(), own.box()];
  const ready = (action) => (...given) => (own.look() === null ? undefined : action(...given));
  const isColour = () => own.look().look === "colour";
  const setExposure = ready((value) => change(isColour() ? { ev: value } : { stops: value ?? 0 }));
  const setSplit = (at) => change({ split: Math.min(1, Math.max(0, at)) });
  return {
    change,
    choose: (show) => change({ show }),
    setExposure,
    expose: ready((by) => setExposure(by + (isColour() ? state.ev ?? own.look().ev : state.stops))),
    zoomBy: ready((factor, u, v) => change({ view: zoomTo(...view(), zoomOf(...view()) * factor, u, v) })),
    fit: () => change({ view: { zoom: null, x: 0.5, y: 0.5 } }),
    oneToOne: ready(() => change({ view: zoomTo(...view(), 1 / own.ratio()) })),
    drag: ready((du, dv) => change({ view: moved(...view(), -du, -dv) })),
    /// By shares of the frame; false where everything is seen already.
    move: ready((du, dv) => {
      const { width, height } = own.box();
      if (zoomOf(...view()) <= fitZoom(own.size(), own.box())) return false;
      change({ view: moved(...view(), du * width, dv * height) });
      return true;
    }),
    cycle(by) {
      const options = own.options();
      const at = options.findIndex((o) => o.key === state.show);
      change({ show: options[(at + by + options.length) % options.length].key });
    },
    /// False where there is no picture to choose.
    pick(i) {
      if (own.sources().length < 2 || i >= own.sources().length) return false;
      change({ left: i });
      return true;
    },
    splits: (u) => state.mode === "split" && Math.abs(u - state.split * own.box().width) < grip,
    split: (u) => setSplit(u / own.box().width),
    shiftSplit: (by) => setSplit(state.split + by),
  };
}
