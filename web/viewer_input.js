// Keys, wheel and pointer over a viewer's frame.

const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/// Calls `actions` (see viewer_actions.js) for the keys of a frame.
export function handleKeys(frame, actions) {
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
  };
  frame.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { key } = event;
    if (arrows[key]) {
      if (!actions.move(...arrows[key])) return;
    } else if (plain[key]) {
      plain[key]();
    } else if (!/^[1-9]$/.test(key) || !actions.pick(Number(key) - 1)) {
      return;
    }
    event.preventDefault();
  });
}

/// `begin(u, v)`, in CSS pixels, gives what follows a drag from there, or undefined; `hover(point)`
/// follows the pointer, null when it leaves; the wheel calls `zoomBy(factor, u, v)`, once the frame has
/// the focus, so that the page scrolls past it.
export function handlePointer(frame, { begin, hover, zoomBy }) {
  let drag = null;
  const at = (event) => {
    const box = frame.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  frame.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    drag = begin(...at(event));
    frame.setPointerCapture(event.pointerId);
  });
  frame.addEventListener("pointermove", (event) => {
    const [u, v] = at(event);
    hover({ u, v });
    drag?.(u, v);
  });
  for (const name of ["pointerup", "pointercancel"]) frame.addEventListener(name, () => { drag = null; });
  frame.addEventListener("pointerleave", () => hover(null));
  frame.addEventListener("wheel", (event) => {
    if (document.activeElement !== frame) return;
    event.preventDefault();
    zoomBy(event.deltaY < 0 ? 1.25 : 0.8, ...at(event));
  }, { passive: false });
}
