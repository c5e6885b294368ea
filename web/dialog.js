// A question in a window of its own: nothing else can be reached until it is answered.
import { button, h, problem } from "./dom.js";

/// Asks with `content` (what h() takes as children). The answer `yes` does `act()`: what it throws is
/// said, and the question stays. Without a `yes` there is only something to read. Gives whether the
/// answer was yes.
export function ask(title, content, yes = null, act = () => {}) {
  return new Promise((resolve) => {
    const trouble = h("div");
    const agree = yes && h("button", { type: "submit" }, yes);
    async function submit(event) {
      event.preventDefault();
      agree.disabled = true;
      try {
        await act();
        dialog.close("yes");
      } catch (error) {
        trouble.replaceChildren(problem(error.message));
      }
      agree.disabled = false;
    }
    const dialog = h("dialog", {
      "aria-label": title,
      onclose: () => {
        dialog.remove();
        resolve(dialog.returnValue === "yes");
      },
    }, h("form", { onsubmit: submit }, h("h2", title), content, trouble,
      h("div.tools", agree, button(yes ? "Back" : "Close", () => dialog.close()))));
    document.body.append(dialog);
    dialog.showModal();
  });
}
