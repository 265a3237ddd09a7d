// Files that are dropped on the page or chosen. They stay in it.
import { batch, signal } from "@preact/signals";

import { readBoxes } from "../files/read.ts";
import { fileScene } from "../scene/catalogue.ts";
import { numbersPerBox } from "../scene/scene.ts";
import { bench } from "../state/client.ts";
import { changeScene, chooseScene, fileName, patch, problem, say } from "../state/store.ts";
import { plural } from "./numbers.ts";
import { wholeView } from "./view.ts";

/** Whether a file hovers over the page. */
export const hovering = signal(false);

export async function openFile(file: File): Promise<void> {
  try {
    const recorded = readBoxes(new Uint8Array(await file.arrayBuffer()), file.name);
    bench().send({ kind: "file", recorded });
    const count = recorded.frames[0]!.length / numbersPerBox(recorded.dimension);
    batch(() => {
      fileName.value = file.name;
      patch({ mode: "play" });
      chooseScene(fileScene);
      // Another file of the same name is another scene.
      changeScene({ count, seed: Math.floor(performance.now()) });
      wholeView();
    });
    say(`${file.name}: ${plural(count, "box")}, ${plural(recorded.frames.length, "frame")}`);
  } catch (error) {
    problem.value = error instanceof Error ? error.message : String(error);
  }
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
