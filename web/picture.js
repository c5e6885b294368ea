// A PNG that is zoomed and moved as the viewer's pictures are; pictures of one group move together.
import { h, setText } from "./dom.js";
import { handleKeys, handlePointer } from "./viewer_input.js";
import { fitZoom, moved, zoomOf, zoomTo } from "./viewport.js";

const whole = { zoom: null, x: 0.5, y: 0.5 };

/// What pictures of one group share: `view` (see viewport.js), as of pictures that fill their frames.
export const zoomGroup = () => ({ view: whole, members: new Set() });

/// What the group's pictures are measured in: frames, so that pictures of any size go together.
const size = { width: 1, height: 1 };
const box = size;

function actionsOf(group, frame) {
  const set = (view) => {
    group.view = view;
    for (const apply of group.members) apply();
  };
  const share = (u, v) => (u === undefined ? [] : [u / frame.clientWidth, v / frame.clientHeight]);
  return {
    zoomBy: (factor, u, v) => set(zoomTo(group.view, size, box, zoomOf(group.view, size, box) * factor, ...share(u, v))),
    fit: () => set(whole),
    drag: (du, dv) => set(moved(group.view, size, box, ...share(-du, -dv))),
    move(du, dv) {
      if (zoomOf(group.view, size, box) <= fitZoom(size, box)) return false;
      set(moved(group.view, size, box, du, dv));
      return true;
    },
  };
}

/// A zoomable picture with the text `alt` and, below it, the zoom and `caption`. `load(url)` shows
/// another version of it without a flash; null: there is none yet.
export function picture(alt, caption, group) {
  const image = h("img", { alt, draggable: false, hidden: true });
  const none = h("span", { className: "note" }, "no picture");
  const frame = h("div", { className: "frame", tabIndex: 0, role: "group",
    "aria-label": `${alt}. Plus and minus zoom, arrows move, 0 fits.` }, image, none);
  const actions = actionsOf(group, frame);
  const level = h("output", { className: "muted" });
  const button = (text, label, onclick) =>
    h("button", { type: "button", className: "small", "aria-label": label, onclick }, text);
  const tools = h("div", { className: "tools" }, button("−", "Zoom out", () => actions.zoomBy(0.5)),
    button("+", "Zoom in", () => actions.zoomBy(2)), button("Fit", "Fit the picture", actions.fit), level);

  function apply() {
    const scale = zoomOf(group.view, size, box);
    const offset = (centre) => `${-100 * (centre - 0.5) * scale}%`;
    image.style.transform = `translate(${offset(group.view.x)}, ${offset(group.view.y)}) scale(${scale})`;
    frame.classList.toggle("zoomed", scale > 1);
    setText(level, scale === 1 ? "" : `${Number(scale.toPrecision(3))}×`);
  }
  group.members.add(apply);
  handleKeys(frame, actions);
  handlePointer(frame, actions);
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
    await h("img", { src: url }).decode().catch(() => {});
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
