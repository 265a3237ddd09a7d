// The theme: the system's, until the reader chooses; on paper, the light one.
import { dark, light } from "../charts/theme.ts";
import type { Theme } from "../charts/theme.ts";

const system = window.matchMedia("(prefers-color-scheme: dark)");
const listeners: (() => void)[] = [];
let chosen: "light" | "dark" | undefined;
let printing = false;

export function theme(): Theme {
  if (printing) return light;
  return (chosen ?? (system.matches ? "dark" : "light")) === "dark" ? dark : light;
}

export function isPrinting(): boolean {
  return printing;
}

/** Calls `listener` whenever the theme changes, or the page is about to be printed. */
export function onTheme(listener: () => void): void {
  listeners.push(listener);
}

function show(): void {
  document.documentElement.dataset["theme"] = theme().name;
  const button = document.getElementById("theme");
  const other = theme().name === "dark" ? "Light" : "Dark";
  if (button !== null) button.textContent = `${other} theme`;
  for (const listener of listeners) listener();
}

export function beginThemes(): void {
  show();
  system.addEventListener("change", show);
  document.getElementById("theme")?.addEventListener("click", () => {
    chosen = theme().name === "dark" ? "light" : "dark";
    show();
  });
  window.addEventListener("beforeprint", () => {
    printing = true;
    show();
  });
  window.addEventListener("afterprint", () => {
    printing = false;
    show();
  });
}
