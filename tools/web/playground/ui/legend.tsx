// What the picture's colours mean, and switches for what can be hidden.
import { dimension, patch, state } from "../state/store.ts";
import { Switch } from "./field.tsx";

export function Legend() {
  const { structure, overlaps, selected, up } = state.value;
  const key = (colour: string) => <i class={`key key-${colour}`} aria-hidden="true" />;
  return (
    <ul class="legend" aria-label="Legend">
      <li>{key("none")} overlaps no other box</li>
      <li>{key("lit")} overlaps another box</li>
      {selected >= 0 && <li>{key("tested")} compared with the selected box</li>}
      <li><Switch label={<>{key("overlap")} where two boxes overlap</>} value={overlaps}
        onChange={(value) => patch({ overlaps: value })} /></li>
      <li><Switch label={<>{key("structure")} the algorithm's rows, cells or nodes</>} value={structure}
        onChange={(value) => patch({ structure: value })} /></li>
      {dimension.value === 2 && <li><Switch label="y points up" value={up}
        hint="On: up, as on a map. Off: down, as on a screen" onChange={(value) => patch({ up: value })} /></li>}
      {selected < 0 && <li class="note">Click a box to see what it is compared with{dimension.value === 3 && "; drag to turn the camera"}.</li>}
    </ul>
  );
}
