// What a viewer shows, as the address holds it: without a key, the page chooses.

const number = (text) => (text?.trim() && Number.isFinite(Number(text)) ? Number(text) : null);
const share = (text, otherwise = 0.5) => Math.min(1, Math.max(0, number(text) ?? otherwise));
const place = (text, otherwise = 0) => Math.max(0, Math.trunc(number(text) ?? otherwise));
const short = (value) => String(Number(value.toPrecision(5)));

const modes = ["one", "split", "difference", "crops"];

/// "x,y,w,h", in pixels; null where that is no rectangle.
function rectangle(text) {
  const [x, y, w, h] = (text ?? "").split(",").map((part) => place(part));
  return w > 0 && h > 0 ? { x, y, w, h } : null;
}

/// `show`: a layer or an error (see shown.js); `ev`: exposure of colours, in stops; `stops`: the same
/// for false colours; `view`: see viewport.js; the rest is for several pictures: `mode`, the `left`
/// and `right` one, where they are `split`, what the difference is measured `by`, and the `crop` (see
/// crop.js).
export function readState(query) {
  const get = (key) => query.get(key);
  const [x, y] = (get("at") ?? "").split(",");
  const zoom = number(get("zoom"));
  return {
    show: get("show") ?? "",
    ev: number(get("ev")),
    stops: number(get("stops")) ?? 0,
    view: { zoom: zoom > 0 ? zoom : null, x: share(x), y: share(y) },
    mode: modes.includes(get("mode")) ? get("mode") : "one",
    left: place(get("left")),
    right: place(get("right"), 1),
    split: share(get("split")),
    by: get("by") ?? "signed",
    crop: rectangle(get("crop")),
  };
}

/// Puts into `query` what differs from the page's own choice.
export function writeState({ show, ev, stops, view, mode, left, right, split, by, crop }, query) {
  const values = {
    show,
    ev: ev !== null && short(ev),
    stops: stops !== 0 && short(stops),
    zoom: view.zoom !== null && short(view.zoom),
    at: view.zoom !== null && `${short(view.x)},${short(view.y)}`,
    mode: mode !== "one" && mode,
    left: left !== 0 && String(left),
    right: mode !== "one" && right !== 1 && String(right),
    split: mode === "split" && split !== 0.5 && short(split),
    by: mode === "difference" && by !== "signed" && by,
    crop: mode === "crops" && crop && Object.values(crop).join(),
  };
  for (const [key, value] of Object.entries(values)) {
    if (value) query.set(key, value);
    else query.delete(key);
  }
}
