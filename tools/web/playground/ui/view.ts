// The visitor's view of the boxes: the same in every panel.
import { signal } from "@preact/signals";

import { defaultView } from "../draw/camera.ts";

export const view = signal(defaultView);

export function zoomBy(factor: number): void {
  view.value = { ...view.value, zoom: Math.min(60, Math.max(0.2, view.value.zoom * factor)) };
}

export function wholeView(): void {
  view.value = defaultView;
}
