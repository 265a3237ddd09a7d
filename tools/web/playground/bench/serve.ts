// Serves the bench behind a port: a worker's global scope, or the page itself if there is no
// worker.
import { loadEngine } from "../engine/engine.ts";
import { Bench } from "./bench.ts";
import type { Reply, Request, Start } from "./protocol.ts";
import { gunzip } from "../../../../bindings/wasm/src/compile.ts";

export interface Port {
  postMessage(reply: Reply, transfer: Transferable[]): void;
  onmessage: ((event: { data: Request | Start }) => void) | null;
}

/** The buffers that a reply transfers instead of copying. */
function buffersOf(reply: Reply): Transferable[] {
  if (reply.kind !== "shown") return [];
  const { boxes, marks, overlaps, panels } = reply.shown;
  const own = panels.flatMap(({ marks: mine }) => mine === undefined ? [] : [mine.buffer]);
  return [boxes.buffer, marks.buffer, overlaps.buffer, ...own];
}

async function start(port: Port, { engine, observing }: Start): Promise<void> {
  const waiting: Request[] = [];
  port.onmessage = ({ data }) => void waiting.push(data as Request);
  const send = (reply: Reply): void => port.postMessage(reply, buffersOf(reply));
  try {
    const [plain, watching] = await Promise.all([gunzip(engine), gunzip(observing)]);
    const loaded = await loadEngine({ engine: plain, observing: watching });
    const bench = new Bench(loaded, send);
    send({ kind: "ready", algorithms: loaded.algorithms() });
    port.onmessage = ({ data }) => void bench.take(data as Request);
    for (const request of waiting) void bench.take(request);
  } catch (error) {
    send({ kind: "failed", message: error instanceof Error ? error.message : String(error), of: "start" });
  }
}

/** The first message holds the engine; later ones wait until it has started. */
export function serve(port: Port): void {
  port.onmessage = ({ data }) => void start(port, data as Start);
}
