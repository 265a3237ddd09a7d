// The theme: the visitor's choice, otherwise the system's.
import { computed, effect, signal } from "@preact/signals";

import { dark, light } from "../draw/colours.ts";

const system = window.matchMedia("(prefers-color-scheme: dark)");
const prefersDark = signal(system.matches);
system.addEventListener("change", ({ matches }) => { prefersDark.value = matches; });

export const chosenTheme = signal<"light" | "dark" | null>(null);
export const theme = computed(() => chosenTheme.value ?? (prefersDark.value ? "dark" : "light"));
export const palette = computed(() => theme.value === "dark" ? dark : light);

effect(() => { document.documentElement.dataset["theme"] = theme.value; });
