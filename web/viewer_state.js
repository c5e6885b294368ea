// What a viewer shows, as the address holds it: without a key, the page chooses.

const finite = (text) => (text !== null && text !== "" && Number.isFinite(Number(text)) ? Number(text) : null);
const share = (text, otherwise) => {
  const value = finite(text);
  return value === null ? otherwise : Math.min(1, Math.max(0, value));
};
const place = (text) => Math.max(0, Math.trunc(finite(text) ?? 0));

export const modes = ["one", "split", "difference"];

/// `show`: a layer or an error (see shown.js); `ev`: exposure of colours, in stops; `stops`: the same
/// for false colours; `view`: see viewport.js; the rest is for several pictures: `mode`, the `left`
/// and `right` one, where they are `split`, and what the difference is measured `by`.
export function readState(query) {
  const [x, y] = (query.get("at") ?? "").split(",");
  const zoom = finite(query.get("zoom"));
  return {
    show: query.get("show") ?? "",
    ev: finite(query.get("ev")),
    stops: finite(query.get("stops")) ?? 0,
    view: { zoom: zoom > 0 ? zoom : null, x: share(x, 0.5), y: share(y, 0.5) },
    mode: modes.includes(query.get("mode")) ? query.get("mode") : "one",
    left: place(query.get("left")),
    right: query.has("right") ? place(query.get("right")) : 1,
    split: share(query.get("split"), 0.5),
    by: query.get("by") ?? "signed",
  };
}

/// Puts into `query` what differs from the page's own choice.
export function writeState(state, query) {
  const { zoom, x, y } = state.view;
  const short = (value) => String(Number(value.toPrecision(5)));
  const values = {
    show: state.show || null,
    ev: state.ev === null ? null : short(state.ev),
    stops: state.stops === 0 ? null : short(state.stops),
    zoom: zoom === null ? null : short(zoom),
    at: zoom === null ? null : `${short(x)},${short(y)}`,
    mode: state.mode === "one" ? null : state.mode,
    left: state.left === 0 ? null : state.left,
    right: state.mode === "one" || state.right === 1 ? null : state.right,
    split: state.mode === "split" && state.split !== 0.5 ? short(state.split) : null,
    by: state.mode === "difference" && state.by !== "signed" ? state.by : null,
  };
  for (const [key, value] of Object.entries(values)) {
    if (value === null) query.delete(key);
    else query.set(key, value);
  }
}
