// The page's script: restores the state from the address, and starts the bench, the loop and the
// interface.
import { render } from "preact";

import { startBench } from "./bench/client.ts";
import { setClient } from "./state/client.ts";
import { firstFrame, frames, Loop, scriptTimes } from "./state/loop.ts";
import { clock, latest, problem, shown, state } from "./state/store.ts";
import { readState, writeState } from "./state/url.ts";
import { App } from "./ui/app.tsx";
import { keepAddress } from "./ui/address.ts";
import { acceptDrops, showFile } from "./ui/drop.ts";
import { openLesson } from "./ui/lesson_view.tsx";
import { Stage } from "./ui/stage.ts";

function takeAddress(): void {
  const read = readState(location.search, location.hash);
  state.value = read.state;
  clock.value = latest.value = read.time;
  problem.value = read.faults.length === 0 ? "" : `The link says ${read.faults.join(" ")}`;
  // A link to a lesson shows the lesson's initial state, unless the link says otherwise.
  if (read.state.mode === "lesson" && !/[?#&](scene|a|n)=/.test(location.search + location.hash)) openLesson(read.state.lesson);
}

takeAddress();
// Fires for links followed within the page, but not for the page's own changes of its address.
window.addEventListener("hashchange", takeAddress);

let loop: Loop | undefined;
const client = startBench((reply) => loop?.receive(reply));
setClient(client);
const stage = new Stage();
loop = new Loop(client, () => stage.paint(), showFile);
stage.onChange = () => loop?.repaint();
acceptDrops();
keepAddress();
if (state.value.embed) document.documentElement.dataset["embed"] = "";

const root = document.getElementById("app")!;
root.replaceChildren();
render(<App stage={stage} />, root);

/** Interface for code that inspects the page: tests, and pages that embed this one. */
const face = {
  get state() { return state.value; },
  get shown() { return shown.value; },
  get firstFrame() { return firstFrame; },
  get inPage() { return client.inPage; },
  /** How many frames the bench has shown, and whether one is in progress or due. */
  get frames() { return frames; },
  get busy() { return loop?.busy ?? true; },
  /** Position of the middle of a box in the first panel, in pixels of the page. */
  where: (box: number) => stage.where(box),
  address: () => writeState(state.value, clock.value),
  scriptTimes,
  get drawn() { return stage.drawn; },
};

declare global {
  interface Window {
    playground: typeof face;
  }
}

window.playground = face;
