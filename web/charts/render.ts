// A chart as an SVG document, made in Node without a DOM. The same chart gives the same bytes on every machine.
import type { Drawn } from "./frame.ts";
import { echarts } from "./echarts.ts";

export interface SvgOptions {
  width: number;
  /** Standard: as high as the chart wants to be. */
  height?: number;
  /** A colour; standard: none, the page shows through. */
  background?: string;
  title?: string;
}

// Texts as wide as the widest of common fonts draws them, so that none runs into the next.
echarts.setPlatformAPI({
  measureText: (text, font) => {
    const size = Number(/([\d.]+)px/.exec(font ?? "")?.[1] ?? 12);
    return { width: text.length * 0.59 * size } as TextMetrics;
  },
});

/** With numbers of at most two decimals, no more than a picture needs, a title and a description. */
export function svgOf(drawn: Drawn, options: SvgOptions): string {
  const { width } = options;
  const height = options.height ?? drawn.height;
  const chart = echarts.init(null, null, { renderer: "svg", ssr: true, width, height });
  try {
    chart.setOption({ ...drawn.option, ...(options.background === undefined ? {} : { backgroundColor: options.background }) });
    return settled(chart.renderToSVGString(), options.title ?? "", drawn.description);
  } finally {
    chart.dispose();
  }
}

function escaped(text: string): string {
  return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
}

function settled(svg: string, title: string, description: string): string {
  const names = `${title === "" ? "" : `<title>${escaped(title)}</title>`}<desc>${escaped(description)}</desc>`;
  // ECharts numbers its ids on from one chart to the next.
  const ids = new Map<string, string>();
  const idOf = (found: string): string => {
    const id = ids.get(found) ?? `part-${ids.size + 1}`;
    ids.set(found, id);
    return id;
  };
  return svg
    .replace(/<style ?>[\s\S]*?<\/style>\s*/g, "")
    .replace(/ class="[^"]*"/g, "")
    .replace(/\bzr\d+-[a-z]+\d+\b/g, idOf)
    .replace(/ (ecmeta_[a-z_]+)="[^"]*"/g, "")
    .replace(/(?<=[\s",(MLHVCQAZmlhvcqaz])-?\d+\.\d{3,}(?:e-?\d+)?/g, (number) => String(Number(Number(number).toFixed(2)) + 0))
    .replace(/^(<svg[^>]*>)/, `$1${names}`) + "\n";
}
