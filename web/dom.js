// Building elements. Text only ever becomes text nodes, so that no name can turn into markup.

/// An element with its properties and children. Properties whose name has a dash, and `role`, are
/// set as attributes, the others as properties. Children are nodes, text or numbers, also in
/// arrays; null, undefined and false are left out.
export function h(tag, props = {}, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(props)) {
    if (value === undefined || value === null) continue;
    if (key === "role" || key.includes("-")) element.setAttribute(key, value);
    else element[key] = value;
  }
  append(element, children);
  return element;
}

/// Appends what h() takes as children.
export function append(element, children) {
  for (const child of [children].flat(Infinity)) {
    if (child === undefined || child === null || child === false) continue;
    element.append(child instanceof Node ? child : String(child));
  }
}

/// Writes text only where it changed: a live region then speaks, and a selection dies, only when
/// it must.
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/// A button that copies what `text()` gives and says so.
export function copyButton(text) {
  const button = h("button", { type: "button", className: "small" }, "Copy");
  button.onclick = async () => {
    try {
      await navigator.clipboard.writeText(text());
      button.textContent = "Copied";
    } catch {
      button.textContent = "Not allowed here: select and copy";
    }
    setTimeout(() => { button.textContent = "Copy"; }, 2000);
  };
  return button;
}

let made = 0;

/// A select with its label; `fill(options, value)`: options are {key, label, group}.
export function labelledSelect(label, onchange) {
  made += 1;
  const id = `select-${made}`;
  const select = h("select", { id, onchange: () => onchange(select.value) });
  let known = "";
  return {
    element: h("span", { className: "choice" }, h("label", { htmlFor: id }, label), " ", select),
    fill(options, value) {
      const next = JSON.stringify(options);
      if (next !== known) {
        known = next;
        const groups = [...new Set(options.map((o) => o.group))];
        const items = (group) => options.filter((o) => o.group === group)
          .map((o) => h("option", { value: o.key }, o.label));
        select.replaceChildren(...groups.flatMap((group) =>
          (group ? h("optgroup", { label: group }, items(group)) : items(group))));
      }
      select.value = value;
    },
  };
}

/// A table of text: `columns` are headings (or {title, number: true}), rows are arrays of what h()
/// takes as children; the first cell of a row heads it.
export function table(columns, rows, className = "") {
  const heads = columns.map((c) => (typeof c === "string" ? { title: c } : c));
  const cell = (content, i) => h(i === 0 ? "th" : "td", {
    scope: i === 0 ? "row" : undefined,
    className: heads[i]?.number ? "number" : "",
  }, content);
  return h("div", { className: "scroll", tabIndex: 0, role: "group", "aria-label": "Table" },
    h("table", { className },
      h("thead", {}, h("tr", {}, heads.map((c) =>
        h("th", { scope: "col", className: c.number ? "number" : "" }, c.title)))),
      h("tbody", {}, rows.map((row) => h("tr", {}, row.map(cell))))));
}
