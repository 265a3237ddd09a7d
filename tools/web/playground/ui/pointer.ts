// Pointer control of a panel's window: select, drag, throw, add and paint boxes; move and turn the
// camera.
import type { Edit } from "../scene/edits.ts";
import { flatCamera, rayAt, solidMatrix, toWorld } from "../draw/camera.ts";
import { pickFlat, pickSolid } from "../draw/pick.ts";
import { clock, count, edit, held, patch, recording, say, shown, state } from "../state/store.ts";
import type { Stage } from "./stage.ts";
import { tool } from "./tools.ts";
import { camera, view, zoomBy } from "./view.ts";

/** A held box's speed is measured over this time, in ms. */
const memory = 90;
/** A recorded drag is sampled at this interval, in ms. */
const recordEvery = 80;

interface Trail {
  at: number;
  x: number;
  y: number;
}

/** The width of an added box, as a fraction of the world's width. */
export const addedShare = 0.035;

export class PointerInput {
  private grip: { dx: number; dy: number; trail: Trail[]; recorded: number } | undefined;
  private camera: { x: number; y: number } | undefined;
  private painted: { x: number; y: number } | undefined;
  private moved = false;
  /** Positions of fingers, for pinching with two of them. */
  private readonly touches = new Map<number, { x: number; y: number }>();

  constructor(private readonly stage: Stage, private readonly panel: number, private readonly element: HTMLElement) {
    element.addEventListener("pointerdown", (event) => this.down(event));
    element.addEventListener("pointermove", (event) => this.move(event));
    element.addEventListener("pointerup", (event) => this.up(event));
    element.addEventListener("pointercancel", (event) => this.up(event));
    element.addEventListener("dblclick", (event) => {
      if (shown.value?.dimension === 2 && this.boxAt(event) < 0) this.add(...this.world(event));
    });
    element.addEventListener("wheel", (event) => {
      // The page scrolls on unless the window has the focus.
      if (!event.ctrlKey && document.activeElement !== element) return;
      event.preventDefault();
      zoomBy(event.deltaY < 0 ? 1.15 : 1 / 1.15);
    }, { passive: false });
  }

  private local({ clientX, clientY }: MouseEvent): [number, number] {
    const { x, y } = this.element.getBoundingClientRect();
    return [clientX - x, clientY - y];
  }

  private world(event: MouseEvent): [number, number] {
    const now = shown.value!;
    return toWorld(flatCamera(now.bounds, this.stage.place(this.panel)!, camera.value), ...this.local(event));
  }

  private boxAt(event: PointerEvent | MouseEvent): number {
    const now = shown.value;
    const place = this.stage.place(this.panel);
    if (now === null || place === undefined) return -1;
    if (now.dimension === 2) {
      const { scale } = flatCamera(now.bounds, place, camera.value);
      const fat = (event as PointerEvent).pointerType === "touch" ? 14 : 5;
      return pickFlat(now.boxes, ...this.world(event), fat / scale);
    }
    const { origin, direction } = rayAt(solidMatrix(now.bounds, place, view.value), place, ...this.local(event));
    return pickSolid(now.boxes, origin, direction);
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0 || shown.value === null) return;
    // A pointer that has already gone cannot be captured.
    if (event.isTrusted) this.element.setPointerCapture(event.pointerId);
    this.touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.moved = false;
    if (this.touches.size > 1) return;
    if (state.value.panel !== this.panel) patch({ panel: this.panel });
    const flat = shown.value.dimension === 2;
    if (flat && tool.value === "paint") {
      this.paint(event);
      return;
    }
    const box = this.boxAt(event);
    if (box >= 0 && tool.value === "remove" && flat) {
      removeBox(box);
      return;
    }
    if (box >= 0) patch({ selected: box });
    if (box >= 0 && flat) this.hold(event, box);
    else this.camera = { x: event.clientX, y: event.clientY };
  }

  private hold(event: PointerEvent, box: number): void {
    const { boxes } = shown.value!;
    const [left, bottom, right, top] = [...boxes.subarray(4 * box, 4 * box + 4)] as [number, number, number, number];
    const [x, y] = this.world(event);
    const at = { x: (left + right) / 2, y: (bottom + top) / 2 };
    this.grip = { dx: at.x - x, dy: at.y - y, trail: [], recorded: 0 };
    held.value = {
      box, time: clock.value, ...at, width: right - left, height: top - bottom, vx: 0, vy: 0,
    };
  }

  private move(event: PointerEvent): void {
    const before = this.touches.get(event.pointerId);
    if (before === undefined) return;
    if (Math.hypot(event.clientX - before.x, event.clientY - before.y) > 3) this.moved = true;
    if (this.touches.size > 1) {
      this.pinch(event);
      return;
    }
    const one = held.value;
    if (one !== null && this.grip !== undefined) {
      const [x, y] = this.world(event);
      const at = { x: x + this.grip.dx, y: y + this.grip.dy };
      this.grip.trail.push({ at: event.timeStamp, ...at });
      held.value = { ...one, ...at, time: clock.value };
      if (recording.value && state.value.playing && event.timeStamp - this.grip.recorded > recordEvery) {
        this.grip.recorded = event.timeStamp;
        edit(held.value);
      }
    } else if (this.painted !== undefined) this.paint(event);
    else if (this.camera !== undefined) this.look(event);
  }

  private look(event: PointerEvent): void {
    const now = shown.value!;
    const place = this.stage.place(this.panel)!;
    const [dx, dy] = [event.clientX - this.camera!.x, event.clientY - this.camera!.y];
    this.camera = { x: event.clientX, y: event.clientY };
    if (now.dimension === 3) {
      const tilt = Math.min(1.5, Math.max(-1.5, view.value.tilt + dy * 0.008));
      view.value = { ...view.value, turn: view.value.turn - dx * 0.008, tilt };
      return;
    }
    if (view.value.zoom === 1 && event.pointerType === "touch") return;
    const { scale, down } = flatCamera(now.bounds, place, camera.value);
    const [x0, y0, x1, y1] = now.bounds as [number, number, number, number];
    view.value = {
      ...view.value, x: view.value.x - dx / scale / (x1 - x0), y: view.value.y - down * dy / scale / (y1 - y0),
    };
  }

  private pinch(event: PointerEvent): void {
    const distance = (): number => {
      const [a, b] = [...this.touches.values()] as [Trail, Trail];
      return Math.hypot(a.x - b.x, a.y - b.y) || 1;
    };
    const before = distance();
    this.touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
    zoomBy(distance() / before);
  }

  private up(event: PointerEvent): void {
    if (!this.touches.delete(event.pointerId)) return;
    const one = held.value;
    if (one !== null && this.grip !== undefined) {
      if (this.moved) edit({ ...one, time: clock.value, ...this.throwSpeed(event.timeStamp) });
      held.value = null;
      say(`Box ${one.box} selected`);
    } else if (this.camera !== undefined && !this.moved && event.type === "pointerup") patch({ selected: -1 });
    this.grip = this.camera = this.painted = undefined;
  }

  /** The speed at which the box was released; a box that was held still stays. */
  private throwSpeed(now: number): { vx: number; vy: number } {
    const trail = this.grip!.trail.filter(({ at }) => now - at < memory);
    const [first, last] = [trail[0], trail[trail.length - 1]];
    const seconds = first === undefined ? 0 : (now - first.at) / 1000;
    if (first === undefined || last === undefined || seconds < 0.01 || !state.value.playing) return { vx: 0, vy: 0 };
    return { vx: (last.x - first.x) / seconds, vy: (last.y - first.y) / seconds };
  }

  private paint(event: PointerEvent): void {
    const [x, y] = this.world(event);
    const size = addedSize();
    if (this.painted !== undefined && Math.hypot(x - this.painted.x, y - this.painted.y) < 1.1 * size) return;
    this.painted = { x, y };
    this.add(x, y);
  }

  private add(x: number, y: number): void {
    addBox(x, y);
  }
}

function addedSize(): number {
  const [x0, , x1] = shown.value!.bounds as [number, number, number];
  return addedShare * (x1 - x0);
}

/** Adds a box at a place and selects it. */
export function addBox(x: number, y: number): void {
  const size = addedSize();
  // A scene may have another number of boxes than requested.
  const box = Math.max(count.value, shown.value!.boxes.length / 4);
  edit({ box, time: clock.value, x, y, width: size, height: size, vx: 0, vy: 0 });
  if (tool.value !== "paint") patch({ selected: box });
  say(`Box ${box} added`);
}

export function removeBox(box: number): void {
  const gone: Edit = { box, time: clock.value, x: 0, y: 0, width: -1, height: -1, vx: 0, vy: 0 };
  edit(gone);
  if (state.value.selected === box) patch({ selected: -1 });
  say(`Box ${box} removed`);
}
