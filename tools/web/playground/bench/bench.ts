// The bench: the boxes at one time, searched by each panel's algorithm. It does not depend on the
// page, so it runs in a worker and in Node.
import type { Engine } from "../engine/types.ts";
import { fileScene, makeScene } from "../scene/catalogue.ts";
import { countWith, edited, place, type Edit } from "../scene/edits.ts";
import { recordedScene } from "../scene/frames.ts";
import type { Scene } from "../scene/scene.ts";
import { duel, measure } from "./measure.ts";
import { Panel, type PanelFrame } from "./panel.ts";
import { Mark, type Reply, type Request, type Setup, type Shown } from "./protocol.ts";

/** Maximum number of overlaps to draw. */
const maxOverlaps = 40_000;

export class Bench {
  private setup: Setup | undefined;
  private scene: Scene | undefined;
  private sceneKey = "";
  private file: Scene | undefined;
  private panels: Panel[] = [];

  constructor(private readonly engine: Engine, private readonly send: (reply: Reply) => void) {}

  /** Answers each request; errors are sent in the reply, not thrown. */
  async take(request: Request): Promise<void> {
    try {
      await this.answer(request);
    } catch (error) {
      const message = error instanceof Error ? error.message : String(error);
      this.send({ kind: "failed", message, of: request.kind });
    }
  }

  private async answer(request: Request): Promise<void> {
    switch (request.kind) {
      case "file":
        this.open(request.name, request.bytes, request.columns);
        return;
      case "setup":
        this.arrange(request.setup);
        return;
      case "frame":
        this.send({ kind: "shown", shown: this.frame(request.time, request.held) });
        return;
      case "measure":
        for await (const measured of measure(this.engine, this.choice, request.counts, request.specs))
          this.send({ kind: "measured", measured });
        this.send({ kind: "measured", measured: null });
        return;
      case "duel":
        this.send({
          kind: "duel", duel: await duel(this.engine, this.boxesAt(...this.last), this.current.dimension),
        });
        return;
    }
  }

  private open(name: string, bytes: Uint8Array, columns: string): void {
    const { dimension, frames, warning } = this.engine.read(name, bytes, columns);
    this.file = recordedScene({ dimension, frames });
    this.sceneKey = "";
    const boxes = frames[0]!.length / (2 * dimension);
    const isEmpty = frames.every((frame) => frame.length === 0);
    this.send({ kind: "opened", opened: {
      name, boxes, frames: frames.length, warning: warning === "" && isEmpty ? `${name}: the file holds no boxes` : warning,
    } });
  }

  /** Time and held box of the last frame. (Its boxes were transferred.) */
  private last: [time: number, held: Edit | null] = [0, null];

  private get choice(): Setup["scene"] {
    if (this.setup === undefined) throw new Error("no scene was set up");
    return this.setup.scene;
  }

  private get current(): Scene {
    if (this.scene === undefined) throw new Error("no scene was set up");
    return this.scene;
  }

  private arrange(setup: Setup): void {
    const key = JSON.stringify(setup.scene);
    if (key !== this.sceneKey) {
      if (setup.scene.name === fileScene && this.file === undefined)
        throw new Error("the link shows a file's boxes, and a link does not hold files: drop the file here again");
      this.scene = setup.scene.name === fileScene ? this.file! : makeScene(setup.scene);
      this.sceneKey = key;
      for (const panel of this.panels) panel.free();
      this.panels = [];
    }
    const same = this.panels.length === setup.panels.length &&
      this.panels.every(({ choice }, at) =>
        choice.spec === setup.panels[at]!.spec && choice.follow === setup.panels[at]!.follow);
    if (!same) {
      for (const panel of this.panels) panel.free();
      this.panels = setup.panels.map((choice) => new Panel(this.engine, choice));
    }
    this.setup = setup;
  }

  private boxesAt(time: number, held: Edit | null): Float32Array<ArrayBuffer> {
    const scene = this.current;
    const boxes = scene.at(time);
    if (scene.dimension === 3) return boxes;
    const edits = this.setup!.edits;
    const all = edited(boxes, edits, time, scene.bounds);
    if (held === null) return all;
    const count = countWith(all.length / 4, [held]);
    const more = 4 * count > all.length ? new Float32Array(4 * count) : all;
    if (more !== all) {
      more.fill(Infinity);
      more.set(all);
      for (let at = all.length; at < more.length; at += 4) more.set([Infinity, Infinity, -Infinity, -Infinity], at);
    }
    place(more, held, held.time, scene.bounds);
    return more;
  }

  private frame(time: number, held: Edit | null): Shown {
    const { dimension, duration } = this.current;
    const setup = this.setup!;
    const boxes = this.boxesAt(time, held);
    this.last = [time, held];
    const count = boxes.length / (2 * dimension);
    const bounds = this.current.boundsAt?.(boxes) ?? this.current.bounds;
    const frames: PanelFrame[] = this.panels.map((panel) => panel.frame(boxes, dimension, setup));
    const pairs = frames.find((frame) => frame.pairs !== undefined)?.pairs ??
      this.engine.find("auto", boxes, dimension).pairs;
    const marks = new Uint8Array(count);
    for (const box of pairs) marks[box] = Mark.lit;
    let present = 0;
    for (let at = 0; at < boxes.length; at += 2 * dimension) {
      if (boxes[at]! <= boxes[at + dimension]!) ++present;
    }
    return {
      scene: setup.scene, time, dimension, bounds, duration, boxes, present, marks, pairs,
      overlaps: setup.overlaps ? intersections(boxes, pairs, dimension) : new Float32Array(),
      panels: frames.map(({ result }) => result),
    };
  }
}

/** Intersections of the boxes of each pair. */
function intersections(boxes: Float32Array, pairs: Uint32Array, dimension: number): Float32Array<ArrayBuffer> {
  const stride = 2 * dimension;
  const count = Math.min(maxOverlaps, pairs.length / 2);
  const parts = new Float32Array(count * stride);
  for (let pair = 0; pair < count; ++pair) {
    const [a, b] = [stride * pairs[2 * pair]!, stride * pairs[2 * pair + 1]!];
    for (let axis = 0; axis < dimension; ++axis) {
      parts[stride * pair + axis] = Math.max(boxes[a + axis]!, boxes[b + axis]!);
      parts[stride * pair + dimension + axis] =
        Math.min(boxes[a + dimension + axis]!, boxes[b + dimension + axis]!);
    }
  }
  return parts;
}
