// The boxes' shadows on the axis of the first panel's sweep, below the picture.
import { useSignalEffect } from "@preact/signals";
import { useRef } from "preact/hooks";

import { shadowsOn } from "../draw/shadows.ts";
import { settingsOf } from "../state/spec.ts";
import { shown, state } from "../state/store.ts";
import type { Stage } from "./stage.ts";
import { palette } from "./themes.ts";

const maxThickness = 8;

function sweptAxis(): 0 | 1 {
  return settingsOf(state.value.panels[0]?.spec ?? "").get("axis") === "y" ? 1 : 0;
}

export function Shadows({ stage }: { stage: Stage }) {
  const element = useRef<HTMLCanvasElement>(null);
  useSignalEffect(() => {
    void stage.layout.value;
    const now = shown.value;
    const axis = sweptAxis();
    const { marks } = palette.value;
    const canvas = element.current;
    const context = canvas?.getContext("2d");
    if (now === null || now.dimension !== 2 || canvas === null || !context) return;
    const [ratio, width, height] = [window.devicePixelRatio, canvas.clientWidth, canvas.clientHeight];
    [canvas.width, canvas.height] = [width * ratio, height * ratio];
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const shadows = shadowsOn(now.boxes, axis);
    const [begin, end] = [Math.min(...shadows.map(({ from }) => from)), Math.max(...shadows.map(({ to }) => to))];
    const thick = Math.min(maxThickness, height / Math.max(1, ...shadows.map(({ row }) => row + 1)));
    for (const { box, from, to, row } of shadows) {
      const mark = (now.panels[0]?.marks ?? now.marks)[box] ?? 0;
      context.fillStyle = marks[mark] ?? marks[0]!;
      context.fillRect((from - begin) / (end - begin) * width, height - (row + 1) * thick,
        Math.max(1, (to - from) / (end - begin) * width), thick > 4 ? thick - 1 : 0.8 * thick);
    }
  });
  return (
    <figure class="shadows">
      <canvas ref={element} aria-hidden="true" />
      <figcaption class="note">The boxes' shadows on {"xy"[sweptAxis()]}, stacked where they overlap. A sweep along
        this axis compares two boxes if their shadows overlap.</figcaption>
    </figure>
  );
}
