// The boxes: a scene or a file, their number, and the sliders that expose performance cliffs.
import { sceneEntries, sceneEntry, fileScene } from "../scene/catalogue.ts";
import type { Knobs } from "../scene/drift.ts";
import { maxBoxes } from "../state/state.ts";
import { changeScene, chooseScene, fileName, state } from "../state/store.ts";
import { fileNote, openFile } from "./drop.ts";
import { Card, Choice, Slider } from "./field.tsx";
import { FileAdvice } from "./file_advice.tsx";
import { grouped } from "./numbers.ts";

interface Knob {
  name: keyof Knobs;
  label: string;
  min: number;
  max: number;
  logarithmic?: boolean;
  text: (value: number) => string;
  hint: string;
}

const percent = (value: number): string => `${Math.round(100 * value)} %`;

const knobs: readonly Knob[] = [
  { name: "ratio", label: "Size ratio", min: 1, max: 300, logarithmic: true, text: (value) => `1 to ${value < 10 ? value.toFixed(1) : Math.round(value)}`,
    hint: "How many times as long as the smallest box the largest is" },
  { name: "clustering", label: "Clustering", min: 0, max: 1, text: percent, hint: "From evenly spread to tight clusters" },
  { name: "moving", label: "Share that moves", min: 0, max: 1, text: percent, hint: "The other boxes rest" },
  { name: "speed", label: "Speed", min: 0, max: 6, text: (value) => `${value.toFixed(1)}×`, hint: "Of the boxes that move" },
];

/** Two significant digits are enough for dragging. */
function rounded(count: number): number {
  const unit = 10 ** Math.max(0, Math.floor(Math.log10(count)) - 1);
  return Math.min(maxBoxes, Math.max(1, Math.round(count / unit) * unit));
}

/** A slider of the drifting boxes. */
export function KnobSlider({ name }: { name: keyof Knobs }) {
  const { scene } = state.value;
  const { label, min, max, logarithmic, text, hint } = knobs.find((knob) => knob.name === name)!;
  return <Slider label={label} value={scene.knobs[name]} min={min} max={max} text={text} hint={hint}
    logarithmic={logarithmic ?? false}
    onChange={(value) => changeScene({ knobs: { ...state.value.scene.knobs, [name]: value } })} />;
}

export function SceneCard() {
  const { scene } = state.value;
  const entry = sceneEntry(scene.name);
  const options = sceneEntries.map((one) => ({ value: one.name, label: one.title, group: one.breaks === undefined ? "Plain" : "That break algorithms" }));
  if (scene.name === fileScene) options.push({ value: fileScene, label: fileName.value || "A file", group: "Yours" });
  return (
    <Card title="Boxes">
      <Choice label="Scene" value={scene.name} options={options} onChange={chooseScene} />
      <p class="note">{entry?.summary ?? "Boxes of a file that was dropped here. It stays in this page."}</p>
      {entry === undefined && fileNote.value !== "" && <FileAdvice text={fileNote.value} />}
      {entry?.breaks !== undefined && <p class="note">It breaks <code>{entry.breaks.spec}</code>: {entry.breaks.why}</p>}
      {scene.name !== fileScene && <Slider label="Number of boxes" value={scene.count} min={10} max={maxBoxes}
        logarithmic text={grouped} onChange={(value) => changeScene({ count: rounded(value) })} />}
      {entry?.knobs === true && knobs.map(({ name }) => <KnobSlider key={name} name={name} />)}
      <div class="row">
        {scene.name !== fileScene &&
          <button type="button" onClick={() => changeScene({ seed: scene.seed % 1000 + 1 })}>Draw new boxes at random</button>}
        <label class="file-choice">
          <span>Open a file …</span>
          <input type="file" class="unseen" accept=".csv,.txt,.btrace,.ply,.obj,.json,.geojson" onChange={(event) => {
            const file = event.currentTarget.files?.[0];
            if (file !== undefined) void openFile(file);
          }} />
        </label>
      </div>
      <p class="note">CSV, trace, PLY, OBJ or GeoJSON; or drop it anywhere on the page.</p>
    </Card>
  );
}
