// Keys, wheel and pointer over a viewer's frame.

const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/// Calls `actions` for the keys of a frame: {zoomBy, fit, move} and, where there are any, {oneToOne,
/// expose, cycle, pick, shiftSplit}.
export function handleKeys(frame, actions) {
  frame.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { key } = event;
    const plain = {
      "+": () => actions.zoomBy(2),
      "=": () => actions.zoomBy(2),
      "-": () => actions.zoomBy(0.5),
      0: () => actions.fit(),
      f: () => actions.fit(),
      o: () => actions.oneToOne?.(),
      e: () => actions.expose?.(0.5),
      E: () => actions.expose?.(-0.5),
      ",": () => actions.shiftSplit?.(-0.05),
      ".": () => actions.shiftSplit?.(0.05),
      "[": () => actions.cycle?.(-1),
      "]": () => actions.cycle?.(1),
    };
    if (arrows[key]) {
      if (!actions.move(...arrows[key].map((d) => 0.1 * d))) return;
    } else if (plain[key]) {
      plain[key]();
    } else if (!/^[1-9]$/.test(key) || !actions.pick?.(Number(key) - 1)) {
      return;
    }
    event.preventDefault();
  });
}

/// A drag calls `drag(du, dv)` with CSS pixels, or `split(u)` where `splits(u)` says that it began on
/// the line (a frame without a line has neither); `hover(point)`, if given, follows the pointer, null
/// when it leaves; the wheel calls `zoomBy(factor, u, v)`, once the frame has the focus, so that the
/// page scrolls past it.
export function handlePointer(frame, { drag, splits, split, hover, zoomBy }) {
  let last = null;
  const at = (event) => {
    const box = frame.getBoundingClientRect();
    return { u: event.clientX - box.left, v: event.clientY - box.top };
  };
  frame.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    last = { ...at(event), splitting: splits?.(at(event).u) };
    frame.setPointerCapture(event.pointerId);
  });
  frame.addEventListener("pointermove", (event) => {
    const here = at(event);
    hover?.(here);
    if (!last) return;
    if (last.splitting) split(here.u);
    else drag(here.u - last.u, here.v - last.v);
    last = { ...here, splitting: last.splitting };
  });
  for (const name of ["pointerup", "pointercancel"]) frame.addEventListener(name, () => { last = null; });
  frame.addEventListener("pointerleave", () => hover?.(null));
  frame.addEventListener("wheel", (event) => {
    if (document.activeElement !== frame) return;
    event.preventDefault();
    zoomBy(event.deltaY < 0 ? 1.25 : 0.8, at(event).u, at(event).v);
  }, { passive: false });
}
