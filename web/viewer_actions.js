// What a reader can do to a viewer, whether by key, pointer or button.
import { cropBetween, movedCrop, scaledCrop } from "./crop.js";
import { fitZoom, moved, pointAt, zoomOf, zoomTo } from "./viewport.js";

const grip = 12;  // CSS pixels on each side of the split line that take hold of it

/// Actions on a viewer: {state, size(), seen, content, options, sources}; `change(values)` changes its state.
/// Until there is content nothing moves.
export function viewerActions(own, change) {
  const { state } = own;
  const view = () => [state.view, own.size(), own.seen.box()];
  const ready = (action) => (...given) => own.content && action(...given);
  const isColour = () => own.content.look.look === "colour";
  const setExposure = ready((value) => change(isColour() ? { ev: value } : { stops: value ?? 0 }));
  const setSplit = (at) => change({ split: Math.min(1, Math.max(0, at)) });
  const setCrop = (crop) => change({ crop });

  /// What a drag from (u, v) does, in CSS pixels: it moves the line, chooses a crop, or moves the picture.
  function begin(u, v) {
    if (state.mode === "split" && Math.abs(u - state.split * own.seen.box().width) < grip) {
      return (at) => setSplit(at / own.seen.box().width);
    }
    if (state.mode === "crops") {
      const from = pointAt(...view(), u, v);
      return (...at) => setCrop(cropBetween(from, pointAt(...view(), ...at), own.size()));
    }
    let last = [u, v];
    return (...at) => {
      change({ view: moved(...view(), last[0] - at[0], last[1] - at[1]) });
      last = at;
    };
  }

  return {
    change,
    choose: (show) => change({ show }),
    setExposure,
    expose: ready((by) => setExposure(by + (isColour() ? state.ev ?? own.content.look.ev : state.stops))),
    zoomBy: ready((factor, u, v) => change({ view: zoomTo(...view(), zoomOf(...view()) * factor, u, v) })),
    fit: () => change({ view: { zoom: null, x: 0.5, y: 0.5 } }),
    oneToOne: ready(() => change({ view: zoomTo(...view(), 1 / window.devicePixelRatio) })),
    begin: ready(begin),
    /// By a tenth of the frame, or of the crop; false where everything is seen already.
    move: ready((right, down) => {
      if (state.mode === "crops") {
        setCrop(movedCrop(state.crop, right, down, own.size()));
        return true;
      }
      const [, size, { width, height }] = view();
      if (zoomOf(...view()) <= fitZoom(size, { width, height })) return false;
      change({ view: moved(...view(), 0.1 * right * width, 0.1 * down * height) });
      return true;
    }),
    /// The line between two pictures, or the size of the crop, by a step.
    shift: ready((step) => {
      if (state.mode === "split") setSplit(state.split + 0.05 * step);
      if (state.mode === "crops") setCrop(scaledCrop(state.crop, step, own.size()));
    }),
    cycle(by) {
      const { options } = own;
      const at = options.findIndex((o) => o.key === state.show);
      change({ show: options[(at + by + options.length) % options.length].key });
    },
    /// False where there is no picture to choose.
    pick(i) {
      if (own.sources.length < 2 || i >= own.sources.length) return false;
      change({ left: i });
      return true;
    },
  };
}
