// A long list in pages.
import { h, setText } from "./dom.js";

export const pageSize = 100;

/// `show(page, total)` gives the page, from 1, that there is: `page` or the nearest. `go(page)` is
/// called when the reader turns.
export function pager(go) {
  let now = 1;
  const turn = (text, label, by) => h("button", {
    type: "button", className: "small", "aria-label": label, onclick: () => go(now + by),
  }, text);
  const before = turn("‹", "Previous page", -1);
  const after = turn("›", "Next page", 1);
  const text = h("output", { className: "muted" });
  return {
    element: h("nav", { className: "tools pager", "aria-label": "Pages" }, before, text, after),
    show(page, total) {
      const last = Math.max(1, Math.ceil(total / pageSize));
      now = Math.min(last, Math.max(1, page));
      before.disabled = now === 1;
      after.disabled = now === last;
      setText(text, `${(now - 1) * pageSize + 1}–${Math.min(total, now * pageSize)} of ${total}`);
      text.parentElement.hidden = last === 1;
      return now;
    },
  };
}
