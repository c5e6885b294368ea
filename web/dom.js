// Building elements. Text only ever becomes text nodes, so that no name can turn into markup.

/// An element: "tag.class.class", its properties if there are any, and children. Properties whose name
/// has a dash, and `role`, are set as attributes, the others as properties. Children are nodes, text or
/// numbers, also in arrays; null, undefined, false and "" are left out.
export function h(tag, ...content) {
  const [name, ...classes] = tag.split(".");
  const element = document.createElement(name);
  if (classes.length > 0) element.className = classes.join(" ");
  if (content[0]?.constructor === Object) {
    for (const [key, value] of Object.entries(content.shift())) {
      if (value === undefined || value === null) continue;
      if (key === "role" || key.includes("-")) element.setAttribute(key, value);
      else element[key] = value;
    }
  }
  append(element, content);
  return element;
}

/// Appends what h() takes as children.
export function append(element, ...children) {
  for (const child of children.flat(Infinity)) {
    if (child === undefined || child === null || child === false || child === "") continue;
    element.append(child instanceof Node ? child : String(child));
  }
}

/// Puts what h() takes as children in the place of what `element` held.
export function replace(element, ...children) {
  element.replaceChildren();
  append(element, ...children);
}

/// Names and values, side by side; values that are empty are left out.
export const facts = (pairs, className = "facts") => h("dl", { className }, pairs
  .filter(([, value]) => value !== "" && value !== null && value !== undefined)
  .map(([name, value]) => h("div", h("dt", name), h("dd", value))));

/// Writes text only where it changed: a live region then speaks, and a selection dies, only when
/// it must.
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/// The address of this view with `query` (URLSearchParams), and giving it that without a new step in the
/// history.
export const addressOf = (query) =>
  `${(location.hash || "#/").split("?")[0]}?${query}`.replaceAll("%2C", ",").replace(/\?$/, "");
export const remember = (query) => history.replaceState(null, "", addressOf(query));

/// A button; `props` as for h().
export const button = (text, onclick, props = {}) => h("button", { type: "button", onclick, ...props }, text);
export const small = (text, onclick) => button(text, onclick, { className: "small" });

/// A small button, whose label says what its sign means.
export const sign = (text, label, onclick) =>
  button(text, onclick, { className: "small", title: label, "aria-label": label });

/// A button that copies what `text()` gives and says so.
export function copyButton(text) {
  const element = small("Copy", async () => {
    try {
      await navigator.clipboard.writeText(text());
      element.textContent = "Copied";
    } catch {
      element.textContent = "Not allowed here: select and copy";
    }
    setTimeout(() => { element.textContent = "Copy"; }, 2000);
  });
  return element;
}

/// What went wrong, or what is doubtful, in words.
export const problem = (text) => h("p.problem", { role: "alert" }, text);
export const warning = (text) => h("p.warning", text);
export const note = (...content) => h("p.note", content);

let made = 0;

/// A select with its label; `fill(options, value)`: options are {key, label, group}.
export function labelledSelect(label, onchange) {
  made += 1;
  const id = `select-${made}`;
  const select = h("select", { id, onchange: () => onchange(select.value) });
  let known = "";
  return {
    element: h("span.choice", h("label", { htmlFor: id }, label), " ", select),
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

/// A table: `columns` are headings, rows arrays of what h() takes as children; the first cell of a row
/// heads it, and with `numbers` the others are numbers.
export function table(columns, rows, numbers = false) {
  const cell = (tag, scope) => (content, i) => h(i === 0 && scope === "row" ? "th" : tag, {
    scope: i === 0 || tag === "th" ? scope : null, className: numbers && i > 0 ? "number" : "" }, content);
  return h("div.scroll", { tabIndex: 0, role: "group", "aria-label": "Table" }, h("table.values",
    h("thead", h("tr", columns.map(cell("th", "col")))),
    h("tbody", rows.map((row) => h("tr", row.map(cell("td", "row")))))));
}
