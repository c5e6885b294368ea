// A picture that can be zoomed to its pixels and dragged; pictures of one group move together.
import { h, setText } from "./dom.js";

const largest = 64;

/// A shared zoom: `scale` 1 fits the frame; (x, y) is the point of the picture, in [0, 1], that lies
/// in the middle of the frame.
export function zoomGroup() {
  return { scale: 1, x: 0.5, y: 0.5, members: new Set() };
}

function move(group, scale, x, y) {
  group.scale = Math.min(largest, Math.max(1, scale));
  const margin = 0.5 / group.scale;
  group.x = Math.min(1 - margin, Math.max(margin, x));
  group.y = Math.min(1 - margin, Math.max(margin, y));
  for (const apply of group.members) apply();
}

/// Zooms by `factor`, keeping the point under (u, v) of the frame, in [0, 1], where it is.
function zoom(group, factor, u = 0.5, v = 0.5) {
  const scale = Math.min(largest, Math.max(1, group.scale * factor));
  const shift = 1 / group.scale - 1 / scale;
  move(group, scale, group.x + (u - 0.5) * shift, group.y + (v - 0.5) * shift);
}

function onKey(group, event) {
  const step = 0.1 / group.scale;
  const actions = {
    "+": () => zoom(group, 2),
    "=": () => zoom(group, 2),
    "-": () => zoom(group, 0.5),
    "0": () => move(group, 1, 0.5, 0.5),
    ArrowLeft: () => move(group, group.scale, group.x - step, group.y),
    ArrowRight: () => move(group, group.scale, group.x + step, group.y),
    ArrowUp: () => move(group, group.scale, group.x, group.y - step),
    ArrowDown: () => move(group, group.scale, group.x, group.y + step),
  };
  if (!actions[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key.startsWith("Arrow") && group.scale === 1) return;
  event.preventDefault();
  actions[event.key]();
}

/// A click zooms in (with Shift: out) where it falls, a drag moves; the wheel zooms while the
/// picture has the focus.
function handlePointer(frame, group) {
  let drag = null;
  const at = (event) => {
    const box = frame.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  };
  frame.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    const [u, v] = at(event);
    drag = { u, v, x: group.x, y: group.y, moved: false };
    frame.setPointerCapture(event.pointerId);
  });
  frame.addEventListener("pointermove", (event) => {
    if (!drag) return;
    const [u, v] = at(event);
    drag.moved ||= Math.hypot(u - drag.u, v - drag.v) > 0.01;
    if (drag.moved) {
      move(group, group.scale, drag.x - (u - drag.u) / group.scale,
        drag.y - (v - drag.v) / group.scale);
    }
  });
  frame.addEventListener("pointerup", (event) => {
    if (drag && !drag.moved) zoom(group, event.shiftKey ? 0.5 : 2, ...at(event));
    drag = null;
  });
  frame.addEventListener("pointercancel", () => { drag = null; });
  frame.addEventListener("wheel", (event) => {
    if (document.activeElement !== frame) return;
    event.preventDefault();
    zoom(group, event.deltaY < 0 ? 1.25 : 0.8, ...at(event));
  }, { passive: false });
}

/// A zoomable picture with the text `alt` and, below it, the zoom and `caption`. `load(url)` shows
/// another version of it without a flash; null: there is none yet.
export function picture(alt, caption, group) {
  const image = h("img", { alt, draggable: false, hidden: true });
  const none = h("span", { className: "note" }, "no picture");
  const frame = h("div", {
    className: "frame",
    tabIndex: 0,
    role: "group",
    title: "Click: zoom in; Shift-click: out; wheel, arrows and 0 once it has the focus",
    "aria-label": `${alt}. Plus and minus zoom, arrows move, 0 fits.`,
  }, image, none);
  const level = h("output", { className: "muted" });
  const button = (text, label, onclick) =>
    h("button", { type: "button", className: "small", "aria-label": label, onclick }, text);
  const tools = h("div", { className: "tools" },
    button("−", "Zoom out", () => zoom(group, 0.5)),
    button("+", "Zoom in", () => zoom(group, 2)),
    button("Fit", "Fit the picture", () => move(group, 1, 0.5, 0.5)),
    level);

  const apply = () => {
    const offset = (centre) => `${-100 * (centre - 0.5) * group.scale}%`;
    image.style.transform = `translate(${offset(group.x)}, ${offset(group.y)}) scale(${group.scale})`;
    frame.classList.toggle("zoomed", group.scale > 1);
    setText(level, group.scale === 1 ? "" : `${Number(group.scale.toPrecision(3))}×`);
  };
  group.members.add(apply);
  frame.addEventListener("keydown", (event) => onKey(group, event));
  handlePointer(frame, group);
  apply();

  let current = null;
  async function load(url) {
    if (url === current) return;
    current = url;
    none.hidden = url !== null;
    if (url === null) {
      image.hidden = true;
      return;
    }
    const next = h("img", { src: url });
    await next.decode().catch(() => {});
    if (url !== current) return;
    image.src = url;
    image.hidden = false;
    await image.decode().catch(() => {});
    image.classList.toggle("coarse", image.naturalWidth < image.clientWidth);
  }
  return {
    element: h("figure", { className: "picture" }, frame,
      h("figcaption", {}, caption && h("span", {}, caption), tools)),
    load,
  };
}
