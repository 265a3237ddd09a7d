// The visitor's view of the boxes: the same in every panel.
import { computed, signal } from "@preact/signals";

import { defaultView, type View } from "../draw/camera.ts";
import { state } from "../state/store.ts";

export const view = signal(defaultView);

/** The view, and the way in which y grows, which a link holds. */
export const camera = computed<View>(() => ({ ...view.value, up: state.value.up }));

export function zoomBy(factor: number): void {
  view.value = { ...view.value, zoom: Math.min(60, Math.max(0.2, view.value.zoom * factor)) };
}

export function wholeView(): void {
  view.value = defaultView;
}
