// The loop: advances time, requests the boxes at that time from the bench, and paints the results.
// At most one frame is in progress, so a slow search makes motion jerky but never blocks the page.
import { effect } from "@preact/signals";

import type { Client } from "../bench/client.ts";
import type { Opened, Reply, Setup } from "../bench/protocol.ts";
import {
  algorithms, clock, duel, duelling, duration, held, latest, measured, measuring, problem, setup, shown, state, told,
} from "./store.ts";

/** Limits the time step, so that motion does not leap after the tab was in the background. */
const longestStep = 0.1;

/** How often counts change, in ms. */
const tellEvery = 120;

/** When a panel that was left out of a frame is requested again, in ms. */
const lateAfter = 120;

/** Script times of the last frames, in ms, for measurements of the page. */
export const scriptTimes: number[] = [];
const maxTimes = 600;

/** Number of frames that the bench has shown. */
export let frames = 0;

/** When the first frame was painted, in ms since the page's start. */
export let firstFrame = NaN;

export class Loop {
  private underway = false;
  private dirty = true;
  private sent: Setup | undefined;
  private before = NaN;
  private script = 0;
  private unpainted = false;
  private late = false;
  private telling = false;
  private toldAt = -Infinity;

  constructor(private readonly client: Client, private readonly paint: () => void,
              private readonly opened: (file: Opened) => void) {
    effect(() => {
      void setup.value;
      void held.value;
      void clock.value;
      this.dirty = true;
    });
    requestAnimationFrame((now) => this.step(now));
  }

  /** Whether a frame, or a panel's results, are in progress or due. */
  get busy(): boolean {
    return this.underway || this.dirty || this.late;
  }

  /** Repaints the same boxes after the size, the camera or the theme has changed. */
  repaint(): void {
    this.unpainted = true;
  }

  receive(reply: Reply): void {
    const begin = performance.now();
    switch (reply.kind) {
      case "ready":
        algorithms.value = reply.algorithms;
        break;
      case "opened":
        this.opened(reply.opened);
        break;
      case "shown":
        this.underway = false;
        shown.value = reply.shown;
        ++frames;
        this.unpainted = true;
        this.tell();
        this.late = reply.shown.panels.some(({ late }) => late);
        // Time may stand still, but results that were too slow for this frame must still be shown.
        if (this.late) setTimeout(() => { this.dirty = true; }, lateAfter);
        break;
      case "measured":
        if (reply.measured === null) measuring.value = false;
        else measured.value = [...measured.value, reply.measured];
        break;
      case "duel":
        duel.value = reply.duel;
        duelling.value = false;
        break;
      case "failed":
        problem.value = reply.message;
        this.underway = false;
        measuring.value = duelling.value = false;
        break;
    }
    this.script += performance.now() - begin;
  }

  private step(now: number): void {
    const begin = performance.now();
    const passed = Math.min(longestStep, (now - this.before) / 1000) || 0;
    this.before = now;
    if (this.unpainted) {
      this.unpainted = false;
      this.paint();
      if (Number.isNaN(firstFrame) && shown.value !== null) firstFrame = performance.now();
    }
    const { playing, pace, mode } = state.value;
    if (!this.underway && mode !== "steps") {
      if (playing) this.advance(passed * pace);
      if (this.dirty) this.ask();
    }
    this.script += performance.now() - begin;
    scriptTimes.push(this.script);
    if (scriptTimes.length > maxTimes) scriptTimes.shift();
    this.script = 0;
    requestAnimationFrame((then) => this.step(then));
  }

  /** Updates the readable counts: at once if the last update was not recent, otherwise soon. */
  private tell(): void {
    if (this.telling) return;
    this.telling = true;
    const now = performance.now();
    const wait = state.value.playing ? Math.max(0, this.toldAt + tellEvery - now) : 0;
    const tell = (): void => {
      this.telling = false;
      this.toldAt = performance.now();
      told.value = shown.value;
    };
    if (wait === 0) tell();
    else setTimeout(tell, wait);
  }

  private advance(seconds: number): void {
    const next = clock.value + seconds;
    const end = duration.value;
    clock.value = next > end && end > 0 ? next % end : next;
    latest.value = Math.max(latest.value, clock.value);
  }

  private ask(): void {
    this.dirty = false;
    this.underway = true;
    if (this.sent !== setup.value) {
      this.sent = setup.value;
      this.client.send({ kind: "setup", setup: setup.value });
    }
    this.client.send({ kind: "frame", time: clock.value, held: held.value });
  }
}
