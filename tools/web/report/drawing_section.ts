// Drawings of the scenes: boxes, and an algorithm's structure over them.
import { onTheme, theme } from "./themes.ts";
import { grouped } from "../charts/numbers.ts";
import { choices, el, picker, say, svg } from "./dom.ts";

export interface Layer {
  algorithm: string;
  caption: string;
  /** An SVG path for each depth of its structure. */
  levels: string[];
}

export interface View {
  axes: string;
  width: number;
  height: number;
  boxes: string;
  layers: Layer[];
}

export interface Drawing {
  scene: string;
  dimension: number;
  /** The number of drawn boxes, and the total. */
  boxes: number;
  of: number;
  views: View[];
}

const maxZoom = 40;

/** A picture that wheel, buttons, pointer and keys zoom and move. */
class Picture {
  readonly element: HTMLElement;
  private readonly image = svg("svg", { role: "img" });
  private view: View | undefined;
  private zoom = 1;
  private at: [number, number] = [0.5, 0.5];

  constructor() {
    this.element = el("div", {
      class: "picture", tabindex: 0, role: "group",
      "aria-label": "Picture of the scene: plus and minus zoom, arrows move, 0 shows all",
      onkeydown: (event) => this.key(event as KeyboardEvent),
    }, this.image);
    this.element.addEventListener("wheel", (event) => {
      // The page scrolls on unless the picture has the focus.
      if (!event.ctrlKey && document.activeElement !== this.element) return;
      event.preventDefault();
      this.scale(event.deltaY < 0 ? 1.25 : 0.8);
    }, { passive: false });
    let from: [number, number] | undefined;
    this.image.addEventListener("pointerdown", (event) => {
      from = [event.clientX, event.clientY];
      if (this.zoom > 1) this.image.setPointerCapture(event.pointerId);
    });
    this.image.addEventListener("pointermove", (event) => {
      if (from === undefined || event.buttons === 0) return;
      const { width, height } = this.image.getBoundingClientRect();
      this.move((from[0] - event.clientX) / width, (from[1] - event.clientY) / height);
      from = [event.clientX, event.clientY];
    });
  }

  show(view: View, drawing: Drawing, layer: Layer | undefined): void {
    this.view = view;
    const what = `${drawing.scene}, ${drawing.dimension}D${drawing.dimension === 3 ? `, seen along the axes ${view.axes}` : ""}: ` +
      `${grouped(drawing.boxes)} boxes${layer === undefined ? "" : ` and ${layer.algorithm}, ${layer.caption}`}`;
    this.image.replaceChildren(
      svg("title", {}, document.createTextNode(what)),
      svg("path", { class: "boxes", d: view.boxes }),
      ...(layer?.levels ?? []).map((d, depth) => svg("path", { class: "level", d, style: `stroke: ${levelColour(depth)}` })));
    this.place();
  }

  whole(): void {
    this.zoom = 1;
    this.at = [0.5, 0.5];
    this.place();
  }

  scale(by: number): void {
    this.zoom = Math.min(maxZoom, Math.max(1, this.zoom * by));
    this.place();
    say(`zoom ${Math.round(this.zoom * 100)} %`);
  }

  private move(x: number, y: number): void {
    this.at = [this.at[0] + x / this.zoom, this.at[1] + y / this.zoom];
    this.place();
  }

  private key(event: KeyboardEvent): void {
    const step = 0.15;
    const actions: Record<string, () => void> = {
      "+": () => this.scale(1.25), "=": () => this.scale(1.25), "-": () => this.scale(0.8), "0": () => this.whole(),
      ArrowLeft: () => this.move(-step, 0), ArrowRight: () => this.move(step, 0),
      ArrowUp: () => this.move(0, -step), ArrowDown: () => this.move(0, step),
    };
    const action = actions[event.key];
    // Without zoom there is nowhere to move, so arrows scroll the page.
    if (action === undefined || (event.key.startsWith("Arrow") && this.zoom === 1) || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    action();
  }

  private place(): void {
    if (this.view === undefined) return;
    const half = 0.5 / this.zoom;
    this.at = [Math.min(1 - half, Math.max(half, this.at[0])), Math.min(1 - half, Math.max(half, this.at[1]))];
    const { width, height } = this.view;
    this.image.setAttribute("viewBox", [
      (this.at[0] - half) * width, (this.at[1] - half) * height, width / this.zoom, height / this.zoom,
    ].map((value) => value.toFixed(2)).join(" "));
  }
}

/** From warm to cool with depth, in either theme. */
function levelColour(depth: number): string {
  const { palette } = theme();
  return palette[[1, 2, 3, 4, 5, 7][depth % 6] ?? 1] ?? "currentColor";
}

export function drawingSection(drawings: readonly Drawing[]): [string, string, HTMLElement] | undefined {
  let drawing = drawings[0];
  if (drawing === undefined) return undefined;
  let axes = "";
  let algorithm = "";
  const picture = new Picture();
  const caption = el("p", { class: "note", "aria-live": "polite" });
  const views = el("div");
  const layers = el("div");

  const show = (): void => {
    if (drawing === undefined) return;
    const view = drawing.views.find((one) => one.axes === axes) ?? drawing.views[0];
    if (view === undefined) return;
    const layer = view.layers.find((one) => one.algorithm === algorithm);
    picture.show(view, drawing, layer);
    const shown = drawing.boxes === drawing.of ? `all ${grouped(drawing.of)} boxes` : `drawn with ${grouped(drawing.boxes)} boxes, as dense as its ${grouped(drawing.of)}`;
    caption.textContent = `${drawing.scene}, ${drawing.dimension}D: ${shown}${layer === undefined ? "" : `. ${layer.algorithm}: ${layer.caption}`}.`;
  };
  const begin = (): void => {
    if (drawing === undefined) return;
    const all = drawing.views;
    axes = all[0]?.axes ?? "";
    views.replaceChildren(...(all.length > 1 ? [choices("Seen on the plane", all.map((view) => [view.axes, view.axes.split("").join(" and ")]), (value) => {
      axes = value;
      show();
    })] : []));
    const names = (all[0]?.layers ?? []).map((layer) => layer.algorithm);
    algorithm = names[0] ?? "";
    layers.replaceChildren(choices("Laid over them", [...names.map((name) => [name, name] as const), ["", "nothing"]], (value) => {
      algorithm = value;
      show();
    }));
    picture.whole();
    show();
  };
  begin();
  onTheme(show);
  const button = (text: string, name: string, action: () => void): HTMLElement =>
    el("button", { type: "button", "aria-label": name, onclick: action }, text);
  return ["scenes", "Scenes", el("section", {}, el("div", { class: "card" },
    el("div", { class: "controls" },
      picker("Scene", drawings.map((one, i) => [String(i), `${one.scene}, ${one.dimension}D`]), (value) => {
        drawing = drawings[Number(value)];
        begin();
      }), views, layers,
      el("div", { class: "choices" }, button("+", "Zoom in", () => picture.scale(1.5)), button("−", "Zoom out", () => picture.scale(1 / 1.5)),
        button("All", "Show all of it", () => picture.whole()))),
    picture.element, caption))];
}
