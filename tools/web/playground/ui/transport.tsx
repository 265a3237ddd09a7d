// Time: play, pause, step, scrub; the pointer's tool; recording; another algorithm beside the others.
import { nameOf } from "../state/spec.ts";
import { maxPanels } from "../state/state.ts";
import { addPanel, clock, dimension, duration, latest, patch, recording, say, state, told } from "../state/store.ts";
import { Buttons, Slider, Switch } from "./field.tsx";
import { stepTime, togglePlaying } from "./keys.ts";
import { tool, tools } from "./tools.ts";
import { view, wholeView, zoomBy } from "./view.ts";

const frame = 1 / 30;

/** An algorithm that no panel shows. */
function nextSpec(): string {
  const taken = new Set(state.value.panels.map(({ spec }) => nameOf(spec)));
  const order = ["grid", "quadtree", "sweep_and_prune", "bvh", "auto", "brute_force"];
  return order.find((name) => !taken.has(name)) ?? "auto";
}

/** A component of its own, because it changes often. */
function TimeSlider() {
  const max = Number.isFinite(duration.value) ? duration.value : Math.max(10, latest.peek());
  const now = state.value.playing ? told.value?.time ?? 0 : clock.value;
  return <Slider label="Time" value={now} min={0} max={max} step={max / 1000}
    text={(value) => `${value.toFixed(1)} s`}
    onChange={(value) => {
      patch({ playing: false });
      clock.value = value;
    }} />;
}

export function Transport() {
  const { playing, pace, edits, panels, mode } = state.value;
  const flat = dimension.value === 2;
  return (
    <div class="transport" role="group" aria-label="Time and tools">
      <div class="row">
        <button type="button" class="strong" onClick={togglePlaying}>{playing ? "Pause" : "Play"}</button>
        <button type="button" onClick={() => stepTime(-frame)} aria-label="One frame back">◂ back</button>
        <button type="button" onClick={() => stepTime(frame)} aria-label="One frame forward">forward ▸</button>
        <TimeSlider />
        <Slider label="Speed of time" value={pace} min={0.1} max={4} logarithmic text={(value) => `${value.toFixed(1)}×`}
          onChange={(value) => patch({ pace: value })} />
      </div>
      {mode === "play" && <div class="row">
        {panels.length < maxPanels &&
          <button type="button" onClick={() => addPanel(nextSpec())}>Compare with another algorithm</button>}
        {flat && <Buttons label="What the pointer does" value={tool.value}
          options={tools.map(({ name, label, hint }) => ({ value: name, label, hint }))}
          onChange={(name) => { tool.value = name; }} />}
        {flat && <Switch label="record drags for replay" value={recording.value}
          hint="Keep the path of a dragged box, to scrub through it later"
          onChange={(value) => { recording.value = value; }} />}
        {flat && recording.value && <span class="note">Drag a box along a path, then move Time back: it goes the same way
          again. Otherwise only the place where it was let go is kept.</span>}
        {edits.length > 0 && <button type="button" onClick={() => {
          patch({ edits: [], selected: -1 });
          say("All boxes are as the scene has them");
        }}>Undo all edits</button>}
        <div class="buttons" role="group" aria-label="Camera">
          <button type="button" aria-label="Zoom in" onClick={() => zoomBy(1.25)}>+</button>
          <button type="button" aria-label="Zoom out" onClick={() => zoomBy(0.8)}>−</button>
          <button type="button" aria-disabled={view.value.zoom === 1} onClick={wholeView}>Show all</button>
        </div>
      </div>}
    </div>
  );
}
