// A long list in pages: the service says where the next begins, the way back is remembered here.
import { button, h, setText } from "./dom.js";

export const pageSize = 100;

/// `place` is {cursor, from}: where the page begins, and how many jobs come before it; both empty on the
/// first page. `go(place)` is called when the reader turns.
export function pager(go) {
  let back = [];
  let here = null;
  let next = null;
  const before = button("‹ Newer", () => go(back.pop() ?? { cursor: "", from: 0 }));
  const after = button("Older ›", () => {
    back.push(here);
    go(next);
  });
  const text = h("output.muted");
  const element = h("nav.tools.pager", { "aria-label": "Pages", hidden: true }, before, text, after);
  return {
    element,
    /// `shown` jobs of `total` are on the page, and the next begins at `cursor`; null: it is the last.
    show(place, shown, total, cursor) {
      if (!place.cursor) back = [];
      here = place;
      next = { cursor, from: place.from + shown };
      before.disabled = !place.cursor;
      after.disabled = cursor === null;
      setText(text, `${shown && place.from + 1}–${place.from + shown} of ${total}`);
      element.hidden = before.disabled && after.disabled;
    },
  };
}
