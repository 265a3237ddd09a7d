// Charts on the page: drawn when they come near the window, and redrawn for another theme or width.
import { echarts } from "../charts/echarts.ts";
import type { Drawn, Place } from "../charts/frame.ts";
import { el } from "./dom.ts";
import { save } from "./downloads.ts";
import { isPrinting, onTheme, theme } from "./themes.ts";

type Draw = (place: Place) => Drawn;

/** In print, charts are made smaller by the style sheet, so that the longest fits on a page. */
function printedWidth(chart: HTMLElement): number {
  return chart.closest(".pair") === null ? 840 : 410;
}

export interface ChartFigure {
  element: HTMLElement;
  /** Shows another chart in its place. */
  show(caption: string, draw: Draw): void;
}

class ChartView {
  readonly element = el("div", { class: "chart" });
  private chart: ReturnType<typeof echarts.init> | undefined;
  private width = 0;
  private near = false;

  constructor(private draw: Draw) {}

  show(draw: Draw): void {
    this.draw = draw;
    this.redraw();
  }

  comeNear(): void {
    if (this.near) return;
    this.near = true;
    this.redraw();
  }

  fit(width: number): void {
    if (Math.abs(width - this.width) < 2) return;
    this.redraw();
  }

  /** The chart as a file, on the theme's background; undefined if it has not been drawn. */
  svg(): string | undefined {
    return this.chart?.renderToSVGString({ useViewBox: true })
      .replace(/>/, `>\n<rect width="100%" height="100%" fill="${theme().background}"/>`);
  }

  redraw(): void {
    if (!this.near && !isPrinting()) return;
    const width = isPrinting() ? printedWidth(this.element) : this.element.clientWidth;
    if (width === 0) return;
    this.width = width;
    const drawn = this.draw({ theme: theme(), width });
    this.element.style.height = `${drawn.height}px`;
    this.chart ??= echarts.init(this.element, null, { renderer: "svg", width, height: drawn.height });
    this.chart.resize({ width, height: drawn.height });
    this.chart.setOption(drawn.option, { notMerge: true });
    this.element.setAttribute("role", "img");
    this.element.setAttribute("aria-label", drawn.description);
  }
}

const views = new Map<Element, ChartView>();

const sights = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    if (entry.isIntersecting) views.get(entry.target)?.comeNear();
  }
}, { rootMargin: "500px" });

const sizes = new ResizeObserver((entries) => {
  for (const entry of entries) views.get(entry.target)?.fit(entry.contentRect.width);
});

onTheme(() => {
  for (const view of views.values()) view.redraw();
});

/** A chart with its caption above. */
export function chartFigure(caption: string, draw: Draw, note = ""): ChartFigure {
  const view = new ChartView(draw);
  views.set(view.element, view);
  sights.observe(view.element);
  sizes.observe(view.element);
  const title = document.createTextNode(caption);
  const button = el("button", { type: "button", class: "quiet downloads", "aria-label": "Save the chart as SVG", onclick: () => {
    const text = view.svg();
    if (text !== undefined) save(`${title.data.toLowerCase().replace(/[^a-z0-9]+/g, "-")}.svg`, "image/svg+xml", text);
  } }, "SVG");
  return {
    element: el("figure", {}, el("figcaption", {}, button, title, note !== "" && el("span", { class: "note" }, note)), view.element),
    show(other, draw) {
      title.data = other;
      view.show(draw);
    },
  };
}
