// The page's side: runs the bench in a worker, or in the page if no worker can be created.
import type { Reply, Request, Start } from "./protocol.ts";

/** The bench's script as a function of its global scope; see build.mjs. */
declare const broadsideBench: (scope: unknown) => void;

export interface Client {
  send(request: Request): void;
  /** Whether searches block the page, because there is no worker. */
  inPage: boolean;
}

/** The engine, from the text embedded in the page. */
function packedEngine(): Start {
  const text = (id: string): string => document.getElementById(id)?.textContent?.trim() ?? "";
  return { kind: "start", engine: text("engine"), observing: text("observing") };
}

export function startBench(receive: (reply: Reply) => void): Client {
  try {
    const url = URL.createObjectURL(new Blob([`(${broadsideBench.toString()})(self)`], { type: "text/javascript" }));
    const worker = new Worker(url);
    worker.onmessage = ({ data }: MessageEvent<Reply>) => receive(data);
    worker.onerror = ({ message }) => receive({ kind: "failed", message: message || "the worker did not start", of: "start" });
    worker.postMessage(packedEngine());
    return { inPage: false, send: (request) => worker.postMessage(request) };
  } catch {
    const port = {
      onmessage: null as ((event: { data: Request | Start }) => void) | null,
      postMessage: (reply: Reply) => void setTimeout(() => receive(reply), 0),
    };
    broadsideBench(port);
    setTimeout(() => port.onmessage?.({ data: packedEngine() }), 0);
    return { inPage: true, send: (data) => void setTimeout(() => port.onmessage?.({ data }), 0) };
  }
}
