// The pointer's tools for boxes.
import { signal } from "@preact/signals";

export type Tool = "move" | "paint" | "remove";

export const tool = signal<Tool>("move");

export const tools: readonly { name: Tool; label: string; hint: string }[] = [
  { name: "move", label: "Drag boxes", hint: "Drag a box and let go to throw it; double-click to add one" },
  { name: "paint", label: "Add boxes", hint: "Drag to add boxes along the way" },
  { name: "remove", label: "Remove boxes", hint: "Click a box to remove it" },
];
