// The visitor's view of the boxes: the same in every panel.
import { signal } from "@preact/signals";

import { standardView } from "../draw/camera.ts";

export const view = signal(standardView);

export function zoomBy(factor: number): void {
  view.value = { ...view.value, zoom: Math.min(60, Math.max(0.2, view.value.zoom * factor)) };
}

export function wholeView(): void {
  view.value = standardView;
}
