// A search of one of the paper's algorithms, step by step: forward and back, beside the listing.
import { useComputed, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

import type { StepAlgorithm, StepOptions } from "../engine/types.ts";
import { stepBoxes } from "../scene/step_boxes.ts";
import type { State } from "../state/state.ts";
import { changeScene, patch, state } from "../state/store.ts";
import { steps } from "../steps/index.ts";
import { Buttons, Slider } from "./field.tsx";
import { grouped } from "./numbers.ts";
import { Notice } from "./stage_view.tsx";
import { StepPicture } from "./step_picture.tsx";
import { StepStateText } from "./step_state.tsx";

const algorithms: readonly { value: StepAlgorithm; label: string }[] = [
  { value: "brute_force", label: "Brute force" },
  { value: "grid", label: "Grid" },
  { value: "sweep_and_prune", label: "Sweep and prune" },
  { value: "quadtree", label: "Quadtree" },
  { value: "bvh", label: "BVH" },
];

function change(part: Partial<State["steps"]>): void {
  patch({ steps: { ...state.value.steps, ...part } });
}

/** The structure of each algorithm, as its picture shows it. */
const structures: Record<StepAlgorithm, string> = {
  brute_force: "", grid: "cells; filled: the current one, or those that the box covers",
  sweep_and_prune: "the sweep line, and the active boxes", quadtree: "nodes; filled: the current one; dotted boxes: not in the tree yet",
  bvh: "nodes; filled: the current ones",
};

function StepLegend({ algorithm }: { algorithm: StepAlgorithm }) {
  const key = (colour: string) => <i class={`key key-${colour}`} aria-hidden="true" />;
  return (
    <ul class="legend" aria-label="Legend">
      <li>{key("about")} the current box</li>
      <li>{key("tested")} compared now (dashed: they are apart)</li>
      <li>{key("lit")} in a pair</li>
      {structures[algorithm] !== "" && <li>{key("structure")} {structures[algorithm]}</li>}
    </ul>
  );
}

export function StepsView() {
  const run = useComputed(() => {
    const { algorithm, count, cell, capacity } = state.value.steps;
    const options: StepOptions = algorithm === "grid" && cell > 0 ? { cell } : algorithm === "quadtree" ? { capacity } :
      algorithm === "bvh" ? { capacity: Math.max(2, capacity) } : {};
    const boxes = stepBoxes(count, state.value.scene.seed);
    return { boxes, key: JSON.stringify([algorithm, count, cell, capacity, state.value.scene.seed]), options };
  });
  const cache = useRef<{ key: string; result: ReturnType<typeof steps> } | null>(null);
  const { boxes, key, options } = run.value;
  const { algorithm, count, cell, capacity } = state.value.steps;
  if (cache.current?.key !== key) cache.current = { key, result: steps(algorithm, boxes, options) };
  const { result } = cache.current;
  const last = result.steps.length - 1;
  const at = Math.min(state.value.steps.at, last);
  const playing = useSignal(false);
  const pace = useSignal(2);
  const go = (to: number): void => change({ at: Math.min(last, Math.max(0, to)) });
  useEffect(() => {
    if (!playing.value) return undefined;
    const timer = setInterval(() => {
      if (state.value.steps.at >= last) playing.value = false;
      else go(state.value.steps.at + 1);
    }, 1000 / pace.value);
    return () => clearInterval(timer);
  }, [playing.value, pace.value, last]);
  const listing = useRef<HTMLOListElement>(null);
  const step = result.steps[at];
  useEffect(() => {
    // Scrolls only the list, never the page.
    const [list, line] = [listing.current, listing.current?.children[step?.line ?? 0]];
    if (list === null || !(line instanceof HTMLElement)) return;
    const top = line.offsetTop - list.offsetTop;
    if (top < list.scrollTop || top + line.offsetHeight > list.scrollTop + list.clientHeight)
      list.scrollTop = top - list.clientHeight / 3;
  }, [step?.line, algorithm]);
  if (step === undefined) return <p class="notice">There is nothing to step through.</p>;
  const past = result.steps.slice(0, at + 1);
  const tests = past.filter(({ outcome }) => outcome === "test").length;
  const reported = past.filter(({ outcome }) => outcome === "reported");
  const found = new Set(reported.flatMap(({ pair }) => pair ?? []));
  const onKey = (event: KeyboardEvent): void => {
    // A slider handles arrows itself.
    if (event.target instanceof HTMLInputElement) return;
    if (event.key === "ArrowRight") go(at + 1);
    else if (event.key === "ArrowLeft") go(at - 1);
    else if (event.key === "Home") go(0);
    else if (event.key === "End") go(last);
    else return;
    event.preventDefault();
  };
  return (
    <div class="steps" onKeyDown={onKey}>
      <header class="intro">
        <h1>An algorithm, one step at a time</h1>
        <p>The picture marks the current box or pair, and the listing marks the current line: the paper's,
          with its errors mended. Step with the
          buttons or the arrow keys.</p>
        <Notice />
      </header>
      <div class="steps-left">
        <Buttons label="Algorithm" value={algorithm} options={algorithms}
          onChange={(value) => change({ algorithm: value, at: 0 })} />
        <StepPicture boxes={boxes} step={step} found={found} />
        <StepLegend algorithm={algorithm} />
        <p class="step-text" role="status" aria-live={playing.value ? "off" : "polite"}>{step.text}</p>
        <div class="row" role="group" aria-label="Steps">
          <button type="button" aria-label="First step" disabled={at === 0} onClick={() => go(0)}>|◂</button>
          <button type="button" disabled={at === 0} onClick={() => go(at - 1)}>◂ Step back</button>
          <button type="button" class="strong" onClick={() => { playing.value = !playing.value; }}>
            {playing.value ? "Pause" : "Play"}</button>
          <button type="button" disabled={at === last} onClick={() => go(at + 1)}>Step forward ▸</button>
          <button type="button" aria-label="Last step" disabled={at === last} onClick={() => go(last)}>▸|</button>
        </div>
        <Slider label="Step" value={at} min={0} max={last} step={1} text={(one) => `${grouped(one + 1)} of ${grouped(last + 1)}`}
          onChange={(one) => go(Math.round(one))} />
        <dl class="step-counts">
          <div><dt>tests so far</dt><dd>{grouped(tests)} of {grouped(result.tests)}</dd></div>
          <div><dt>pairs so far</dt><dd>{grouped(reported.length)} of {grouped(result.pairs.length)}</dd></div>
        </dl>
      </div>
      <div class="steps-right">
        <section class="card" aria-label="Listing">
          <h2>Listing</h2>
          <ol ref={listing} class="listing" tabIndex={0} aria-label="Lines of the listing">
            {result.listing.map((line, one) => (
              <li key={one} aria-current={one === step.line ? "step" : undefined}><code>{line === "" ? " " : line}</code></li>
            ))}
          </ol>
        </section>
        <section class="card" aria-label="State">
          <h2>State</h2>
          <StepStateText state={step.state} />
        </section>
        <section class="card" aria-label="Boxes">
          <h2>Boxes</h2>
          <Slider label="Number of boxes" value={count} min={2} max={40} step={1}
            onChange={(value) => change({ count: Math.round(value), at: 0 })} />
          {algorithm === "grid" && <Slider label="Cell" value={cell} min={0} max={8} step={0.25}
            text={(value) => value === 0 ? "chosen by the algorithm" : String(value)} onChange={(value) => change({ cell: value, at: 0 })} />}
          {(algorithm === "quadtree" || algorithm === "bvh") && <Slider label="Capacity of a leaf"
            value={algorithm === "bvh" ? Math.max(2, capacity) : capacity} min={algorithm === "bvh" ? 2 : 1} max={16} step={1}
            onChange={(value) => change({ capacity: Math.round(value), at: 0 })} />}
          <Slider label="Steps in a second" value={pace.value} min={0.5} max={30} logarithmic
            text={(value) => value.toFixed(1)} onChange={(value) => { pace.value = value; }} />
          <button type="button" onClick={() => {
            changeScene({ seed: state.value.scene.seed % 1000 + 1 });
            change({ at: 0 });
          }}>Draw new boxes at random</button>
        </section>
      </div>
    </div>
  );
}
