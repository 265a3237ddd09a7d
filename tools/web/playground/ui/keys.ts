// Keyboard control of a panel's window.
import { clock, edit, patch, say, shown, state } from "../state/store.ts";
import { addBox, removeBox } from "./pointer.ts";
import { plural } from "./numbers.ts";
import { view, wholeView, zoomBy } from "./view.ts";

export const keysHelp = "Space plays and pauses. Tab leaves. N and P select the next and the previous box; arrows move " +
  "it, or the camera if none is selected. A adds a box, Delete removes the selected one, Escape lets it go. " +
  "Plus and minus zoom, 0 shows all. Comma and period step back and forward in time.";

/** One press moves by this fraction of the picture's width. */
const stride = 0.02;

/** Seconds per step when stepping frame by frame. */
const frame = 1 / 30;

function moveSelected(dx: number, dy: number): void {
  const { selected } = state.value;
  const { boxes, bounds } = shown.value!;
  const [left, bottom, right, top] = [...boxes.subarray(4 * selected, 4 * selected + 4)] as [number, number, number, number];
  const [x0, y0, x1, y1] = bounds as [number, number, number, number];
  edit({
    box: selected, time: clock.value, width: right - left, height: top - bottom, vx: 0, vy: 0,
    x: (left + right) / 2 + dx * stride * (x1 - x0), y: (bottom + top) / 2 + dy * stride * (y1 - y0),
  });
}

function select(way: 1 | -1): void {
  const now = shown.value!;
  const count = now.boxes.length / (2 * now.dimension);
  let box = state.value.selected;
  // Absent boxes are skipped.
  for (let tries = 0; tries < count; ++tries) {
    box = box < 0 ? (way > 0 ? 0 : count - 1) : (box + way + count) % count;
    if (now.boxes[2 * now.dimension * box]! <= now.boxes[(2 * box + 1) * now.dimension]!) break;
  }
  patch({ selected: box });
  const partners = new Set<number>();
  for (let at = 0; at < now.pairs.length; at += 2) {
    if (now.pairs[at] === box) partners.add(now.pairs[at + 1]!);
    if (now.pairs[at + 1] === box) partners.add(now.pairs[at]!);
  }
  say(`Box ${box}, overlaps ${plural(partners.size, "box")}`);
}

export function togglePlaying(): void {
  const playing = !state.value.playing;
  patch({ playing });
  say(playing ? "Playing" : "Paused");
}

export function stepTime(seconds: number): void {
  patch({ playing: false });
  clock.value = Math.max(0, clock.value + seconds);
}

function arrow(dx: number, dy: number): void {
  const flat = shown.value?.dimension === 2;
  const along = state.value.up ? -dy : dy;
  if (flat && state.value.selected >= 0) moveSelected(dx, along);
  else if (flat) view.value = { ...view.value, x: view.value.x + 0.05 * dx, y: view.value.y + 0.05 * along };
  else view.value = { ...view.value, turn: view.value.turn - 0.1 * dx, tilt: Math.min(1.5, Math.max(-1.5, view.value.tilt - 0.1 * dy)) };
}

const actions: Record<string, () => void> = {
  " ": togglePlaying,
  n: () => select(1),
  p: () => select(-1),
  ArrowLeft: () => arrow(-1, 0),
  ArrowRight: () => arrow(1, 0),
  ArrowUp: () => arrow(0, -1),
  ArrowDown: () => arrow(0, 1),
  a: () => {
    const [x0, y0, x1, y1] = shown.value!.bounds as [number, number, number, number];
    if (shown.value!.dimension === 2) addBox((x0 + x1) / 2, (y0 + y1) / 2);
  },
  Delete: () => {
    if (state.value.selected >= 0 && shown.value!.dimension === 2) removeBox(state.value.selected);
  },
  Escape: () => {
    patch({ selected: -1 });
    say("No box is selected");
  },
  "+": () => zoomBy(1.25),
  "=": () => zoomBy(1.25),
  "-": () => zoomBy(0.8),
  "0": wholeView,
  ",": () => stepTime(-frame),
  ".": () => stepTime(frame),
};

export function windowKey(event: KeyboardEvent): void {
  if (event.ctrlKey || event.metaKey || event.altKey || shown.value === null) return;
  const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (action === undefined) return;
  event.preventDefault();
  action();
}
