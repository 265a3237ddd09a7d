// Files dropped on the page or chosen. They never leave it.
import { batch, signal } from "@preact/signals";

import type { Opened } from "../bench/protocol.ts";
import { fileScene } from "../scene/catalogue.ts";
import { withoutOptions } from "../state/advice.ts";
import { bench } from "../state/client.ts";
import { defaultState } from "../state/state.ts";
import { changeScene, chooseScene, fileName, patch, problem, say, state } from "../state/store.ts";
import { plural } from "./numbers.ts";
import { wholeView } from "./view.ts";

/** Whether a file hovers over the page. */
export const hovering = signal(false);

/** How the open file was read, if that is uncertain. */
export const fileNote = signal("");

let last: File | undefined;

/** Reads the last file again, with other columns. */
export async function openAgain(columns: string): Promise<void> {
  if (last !== undefined) await openFile(last, columns);
}

/** Lets the bench read a file; it replies that the file is open, or why not. */
export async function openFile(file: File, columns = ""): Promise<void> {
  last = file;
  try {
    bench().send({ kind: "file", name: file.name, bytes: new Uint8Array(await file.arrayBuffer()), columns });
  } catch (error) {
    problem.value = error instanceof Error ? error.message : String(error);
  }
}

export function showFile({ name, boxes, frames, warning }: Opened): void {
  batch(() => {
    fileName.value = name;
    fileNote.value = warning;
    patch({ mode: "play" });
    chooseScene(fileScene);
    // The settings of the opening scene do not suit other boxes.
    if (state.value.panels === defaultState.panels) patch({ panels: [{ spec: "auto", follow: false }] });
    // Another file of the same name is another scene.
    changeScene({ count: boxes, seed: Math.floor(performance.now()) });
    wholeView();
  });
  say(`${name}: ${plural(boxes, "box")}, ${plural(frames, "frame")}${warning === "" ? "" : `. ${withoutOptions(warning).text}`}`);
}

export function acceptDrops(): void {
  window.addEventListener("dragover", (event) => {
    if (event.dataTransfer?.types.includes("Files") !== true) return;
    event.preventDefault();
    hovering.value = true;
  });
  window.addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) hovering.value = false;
  });
  window.addEventListener("drop", (event) => {
    event.preventDefault();
    hovering.value = false;
    const file = event.dataTransfer?.files[0];
    if (file !== undefined) void openFile(file);
  });
}
