// Sharing: the link, the page to embed, code, pictures and films.
import { signal } from "@preact/signals";

import { gifOf } from "../out/gif.ts";
import { pngOf } from "../out/png.ts";
import { saveAs } from "../out/save.ts";
import { webmOf } from "../out/webm.ts";
import { svgOf } from "../draw/svg.ts";
import { languages, linesFor, type Language } from "../state/lines.ts";
import { dimension, problem, say, shown, state } from "../state/store.ts";
import { address, embedding } from "./address.ts";
import { Buttons, Card } from "./field.tsx";
import type { Stage } from "./stage.ts";

const language = signal<Language>("C++");
const filming = signal("");

async function copy(text: string, what: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // A page from a folder may have only the old clipboard interface.
    const area = document.createElement("textarea");
    area.value = text;
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
  say(`${what} copied`);
}

function captions(): string[] {
  return state.value.panels.map(({ spec }, at) => {
    const result = shown.value?.panels[at];
    return result === undefined ? spec : `${spec}: ${result.statistics.tests} tests, ${result.pairs} pairs`;
  });
}

/** Reports an error instead of saving. */
export async function attempt(work: () => Promise<void> | void): Promise<void> {
  try {
    await work();
  } catch (error) {
    problem.value = error instanceof Error ? error.message : String(error);
  } finally {
    filming.value = "";
  }
}

export function ShareCard({ stage }: { stage: Stage }) {
  const { panels, panel } = state.value;
  const choice = panels[panel] ?? panels[0]!;
  const lines = linesFor(language.value, choice.spec, dimension.value, choice.follow);
  const film = (kind: "GIF" | "WebM", make: () => Promise<Blob>): Promise<void> => attempt(async () => {
    filming.value = kind;
    saveAs(await make(), `broadside.${kind.toLowerCase()}`);
  });
  return (
    <Card title="Share, save, and use it in your program">
      <div class="row">
        <button type="button" onClick={() => void copy(address(), "Link")}>Copy link</button>
        <button type="button" onClick={() => void copy(embedding(), "Code to embed")}>Copy code to embed</button>
      </div>
      <Buttons label="Language" value={language.value} options={languages.map((one) => ({ value: one, label: one }))}
        onChange={(one) => { language.value = one; }} />
      <pre class="lines" tabIndex={0} aria-label={`Lines of ${language.value}`}><code>{lines}</code></pre>
      <div class="row">
        <button type="button" onClick={() => void copy(lines, "Lines")}>Copy lines</button>
        <button type="button" onClick={() => void attempt(async () =>
          saveAs(await pngOf(stage, captions()), "broadside.png"))}>PNG</button>
        <button type="button" onClick={() => void attempt(() => {
          const painting = stage.painting();
          if (painting !== undefined)
            saveAs(new Blob([svgOf(painting, captions())], { type: "image/svg+xml" }), "broadside.svg");
        })}>SVG</button>
        <button type="button" disabled={filming.value !== ""} onClick={() => void film("GIF", () => gifOf(stage.canvas, 3))}>
          {filming.value === "GIF" ? "Filming …" : "GIF, 3 s"}</button>
        <button type="button" disabled={filming.value !== ""} onClick={() => void film("WebM", () => webmOf(stage.canvas, 5))}>
          {filming.value === "WebM" ? "Filming …" : "WebM, 5 s"}</button>
      </div>
    </Card>
  );
}
