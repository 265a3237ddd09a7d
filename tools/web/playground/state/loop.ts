// The loop: time goes on, the bench is asked for the boxes at that time, and what it shows is painted. At most one
// frame is under way, so a slow search makes motion jerk and never makes the page wait.
import { effect } from "@preact/signals";

import type { Client } from "../bench/client.ts";
import type { Opened, Reply, Setup } from "../bench/protocol.ts";
import {
  algorithms, clock, duel, duelling, duration, held, latest, measured, measuring, problem, setup, shown, state, told,
} from "./store.ts";

/** Motion does not leap when the tab was in the background. */
const longestStep = 0.1;

/** How often counts change, in ms. */
const tellEvery = 120;

/** When a panel that was left out of a frame is asked for again, in ms. */
const lateAfter = 120;

/** The script's times of the last frames, in ms, for those who measure the page. */
export const scriptTimes: number[] = [];
const mostTimes = 600;

/** How many frames the bench has shown. */
export let frames = 0;

/** When the first frame was painted, in ms from the page's start. */
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

  /** Whether a frame is under way or due, or a panel's results are. */
  get busy(): boolean {
    return this.underway || this.dirty || this.late;
  }

  /** Another picture of the same boxes is wanted: the size, the camera or the theme changed. */
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
        // Time may stand still; what was too slow for this frame is still to be shown.
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
    if (scriptTimes.length > mostTimes) scriptTimes.shift();
    this.script = 0;
    requestAnimationFrame((then) => this.step(then));
  }

  /** At once where it was not told just before, else soon. */
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
    const most = duration.value;
    clock.value = next > most && most > 0 ? next % most : next;
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
