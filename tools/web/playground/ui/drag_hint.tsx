// "Drag this box": shows beside a box that it can be moved, until the visitor has moved one.
import { useSignalEffect } from "@preact/signals";
import { useRef } from "preact/hooks";

import { fileScene } from "../scene/catalogue.ts";
import { held, shown, state } from "../state/store.ts";
import { between } from "./numbers.ts";
import type { Stage } from "./stage.ts";
import { camera } from "./view.ts";

/** The largest of the boxes near the middle. */
function draggable(boxes: Float32Array, bounds: ArrayLike<number>): number {
  const [x0, y0, x1, y1] = [bounds[0]!, bounds[1]!, bounds[2]!, bounds[3]!];
  let [best, most] = [-1, 0];
  for (let at = 0; at < boxes.length; at += 4) {
    const [left, bottom, right, top] = [boxes[at]!, boxes[at + 1]!, boxes[at + 2]!, boxes[at + 3]!];
    const [x, y] = [((left + right) / 2 - x0) / (x1 - x0), ((bottom + top) / 2 - y0) / (y1 - y0)];
    const area = (right - left) * (top - bottom);
    if (Math.abs(x - 0.5) < 0.2 && Math.abs(y - 0.5) < 0.2 && area > most) [best, most] = [at / 4, area];
  }
  return best;
}

export function DragHint({ stage }: { stage: Stage }) {
  const element = useRef<HTMLParagraphElement>(null);
  const box = useRef(-1);
  const scene = useRef("");
  useSignalEffect(() => {
    const now = shown.value;
    void [camera.value, stage.layout.value];
    const { mode, edits, embed, selected } = state.value;
    const hint = element.current;
    if (hint === null) return;
    hint.hidden = now === null || now.dimension !== 2 || now.scene.name === fileScene || mode !== "play" || embed || edits.length > 0 || selected >= 0 ||
      held.value !== null;
    if (hint.hidden || now === null) return;
    if (scene.current !== now.scene.name || 4 * box.current >= now.boxes.length) {
      scene.current = now.scene.name;
      box.current = draggable(now.boxes, now.bounds);
    }
    hint.dataset["box"] = String(box.current);
    const place = stage.rectangle(0, box.current);
    hint.hidden = place === undefined;
    const around = hint.parentElement;
    if (place === undefined || around === null) return;
    // The label stays in the picture; its arrow points to the box.
    const middle = between(place.x + place.width / 2, 0, around.clientWidth);
    const x = between(middle, hint.offsetWidth / 2 + 4, around.clientWidth - hint.offsetWidth / 2 - 4);
    const y = between(place.y, hint.offsetHeight + 12, around.clientHeight);
    hint.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
    hint.style.setProperty("--arrow", `${Math.round(middle - x)}px`);
  });
  return <p ref={element} class="drag-hint" hidden aria-hidden="true">Drag this box</p>;
}
