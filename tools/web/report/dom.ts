// Creates elements in one line.
type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | ((event: Event) => void) | undefined>;

/**
 * An element. An attribute that begins with "on" is a listener; true is an empty attribute, false
 * and undefined are none.
 */
export function el<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag, attributes: Attributes = {}, ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name.slice(2), value);
    else if (value !== undefined && value !== false) element.setAttribute(name, value === true ? "" : String(value));
  }
  add(element, ...children);
  return element;
}

export function add(parent: Node, ...children: Child[]): void {
  for (const child of children) {
    if (child !== null && child !== undefined && child !== false)
      parent.appendChild(typeof child === "string" ? document.createTextNode(child) : child);
  }
}

/** As el(), for an SVG element. */
export function svg(tag: string, attributes: Record<string, string | number>, ...children: Node[]): SVGElement {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  for (const child of children) element.appendChild(child);
  return element;
}

/** Announces a text to screen readers. */
export function say(text: string): void {
  const place = document.getElementById("said");
  if (place !== null) place.textContent = text;
}

let ids = 0;
export function newId(name: string): string {
  return `${name}-${++ids}`;
}

/** A labelled list of choices. */
export function picker(
  label: string, options: readonly (readonly [value: string, text: string])[], changed: (value: string) => void,
): HTMLLabelElement {
  const select = el("select", { onchange: () => changed(select.value) },
    ...options.map(([value, text]) => el("option", { value }, text)));
  return el("label", {}, label, select);
}

/** Radio buttons, with the first one selected. */
export function choices(
  label: string, options: readonly (readonly [value: string, text: string])[], changed: (value: string) => void,
): HTMLFieldSetElement {
  const name = newId("choice");
  return el("fieldset", {}, el("legend", {}, label), el("div", { class: "choices" },
    ...options.map(([value, text], i) => el("label", {},
      el("input", { type: "radio", name, value, checked: i === 0, onchange: () => changed(value) }),
      el("span", {}, text)))));
}
