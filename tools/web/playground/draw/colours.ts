// Colours of each theme: one accent for each state of a pair.

/** Red, green, blue and opacity, from 0 to 1. */
export type Colour = readonly [number, number, number, number];

export interface Palette {
  background: string;
  text: string;
  muted: string;
  /** By mark: in no pair, in a pair, tested, tested and in a pair, selected, faded. */
  marks: readonly string[];
  overlap: string;
  /** Levels of a structure, from the coarsest down. */
  levels: readonly string[];
}

export const light: Palette = {
  background: "#ffffff", text: "#1d2430", muted: "#5a6473",
  marks: ["#7c8899", "#c84a00", "#0067a8", "#c84a00", "#1d2430", "#c3cad4"],
  overlap: "#c84a00",
  levels: ["#00806a", "#7a5cc0", "#00806a", "#7a5cc0"],
};

export const dark: Palette = {
  background: "#12161d", text: "#e6e9ef", muted: "#a5aebd",
  marks: ["#7f8b9d", "#ff9350", "#5cb8f5", "#ff9350", "#ffffff", "#3d4654"],
  overlap: "#ff9350",
  levels: ["#2fc49a", "#b49cf0", "#2fc49a", "#b49cf0"],
};

/** Opacity of a box's inside, by mark. */
export const fills: readonly number[] = [0.16, 0.34, 0.32, 0.5, 0.45, 0.07];

export function rgb(text: string): [number, number, number] {
  const value = Number.parseInt(text.slice(1), 16);
  return [(value >> 16) / 255, ((value >> 8) & 255) / 255, (value & 255) / 255];
}

export function levelColour(palette: Palette, level: number): string {
  return palette.levels[level % palette.levels.length] ?? palette.muted;
}
