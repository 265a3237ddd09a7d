// The picture: one canvas behind all panels, and the position of each panel's window on it.
import { effect, signal } from "@preact/signals";

import { CanvasPainter, projectionOf } from "../draw/canvas_painter.ts";
import type { Drawn, Painter, Painting, Place } from "../draw/painting.ts";
import { WebglPainter } from "../draw/webgl_painter.ts";
import { shown, state } from "../state/store.ts";
import { palette } from "./themes.ts";
import { camera } from "./view.ts";

/** A finer resolution than this costs much and shows little. */
const maxRatio = 2;

export class Stage {
  readonly canvas = document.createElement("canvas");
  private painter: Painter;
  private holder: HTMLElement | undefined;
  private places: Place[] = [];
  private readonly observed = new WeakSet<Element>();
  private readonly observer = new ResizeObserver(() => this.measure());
  /** Changes with the places of the panels' windows. */
  readonly layout = signal(0);
  /** Called when the same boxes must be repainted. */
  onChange: () => void = () => {};

  constructor() {
    this.canvas.className = "picture";
    this.canvas.setAttribute("aria-hidden", "true");
    try {
      this.painter = new WebglPainter(this.canvas);
    } catch {
      this.painter = new CanvasPainter(this.canvas);
    }
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", () => {
      this.painter = new WebglPainter(this.canvas);
      this.measure();
    });
    effect(() => {
      void palette.value;
      void camera.value;
      this.onChange();
    });
  }

  /** The element that holds the panels; their windows have the class "window". */
  attach(holder: HTMLElement): void {
    this.holder = holder;
    holder.prepend(this.canvas);
    this.observer.disconnect();
    this.observer.observe(holder);
    this.measure();
  }

  measure(): void {
    if (this.holder === undefined) return;
    const all = this.holder.getBoundingClientRect();
    this.painter.resize(all.width, all.height, Math.min(maxRatio, window.devicePixelRatio));
    this.places = [...this.holder.querySelectorAll(".window")].map((one) => {
      // Counts that wrap take height from a window. Observing an element triggers a notification at
      // once, so each is observed only once.
      if (!this.observed.has(one)) {
        this.observed.add(one);
        this.observer.observe(one);
      }
      const { x, y, width, height } = one.getBoundingClientRect();
      return { x: x - all.x, y: y - all.y, width, height };
    });
    this.layout.value = this.layout.peek() + 1;
    this.onChange();
  }

  /** The rectangle that a box takes in a panel's window. */
  rectangle(at: number, box: number): Place | undefined {
    const painting = this.painting();
    const panel = painting?.panels[at];
    if (painting === undefined || panel === undefined || !(box in painting.marks)) return undefined;
    const [x, y, width, height] = projectionOf(painting, panel)(painting.boxes, 2 * painting.dimension * box);
    return { x, y, width, height };
  }

  /** Position of the middle of a box in the first panel, in pixels of the page. */
  where(box: number): [x: number, y: number] | undefined {
    const [one, place] = [this.rectangle(0, box), this.places[0]];
    if (one === undefined || place === undefined || this.holder === undefined) return undefined;
    const { x, y } = this.holder.getBoundingClientRect();
    return [x + place.x + one.x + one.width / 2, y + place.y + one.y + one.height / 2];
  }

  place(panel: number): Place | undefined {
    return this.places[panel];
  }

  /** The graphics card's work for the last picture. */
  get drawn(): Drawn | undefined {
    return this.painter.drawn;
  }

  painting(): Painting | undefined {
    const now = shown.value;
    if (now === null) return undefined;
    const { dimension, bounds, boxes, marks, overlaps, panels } = now;
    return {
      dimension, bounds, boxes, marks, overlaps, view: camera.value, palette: palette.value,
      panels: this.places.slice(0, state.value.panels.length).map((place, at) => {
        const panel = panels[at];
        const selection = panel?.selection;
        return {
          place, outline: panel?.outline, marks: panel?.marks,
          tests: selection === undefined ? undefined : { box: selection.box, others: selection.tested },
        };
      }),
    };
  }

  paint(): void {
    const painting = this.painting();
    if (painting !== undefined) this.painter.paint(painting);
  }
}
