// A panel: an algorithm's name, its window onto the boxes, and its counts.
import { useEffect, useRef } from "preact/hooks";

import type { PanelResult } from "../bench/protocol.ts";
import { nameOf, settingsOf, withSetting } from "../state/spec.ts";
import { changePanel, removePanel, state, told } from "../state/store.ts";
import { PanelAlgorithm } from "./algorithm_choice.tsx";
import { DragHint } from "./drag_hint.tsx";
import { Explanation } from "./explanation.tsx";
import { Switch } from "./field.tsx";
import { keysHelp, windowKey } from "./keys.ts";
import { bytes, duration, grouped } from "./numbers.ts";
import { PointerInput } from "./pointer.ts";
import type { Stage } from "./stage.ts";
import { tool } from "./tools.ts";

export function PanelView({ at, stage }: { at: number; stage: Stage }) {
  const element = useRef<HTMLDivElement>(null);
  const choice = state.value.panels[at];
  useEffect(() => {
    if (element.current !== null) new PointerInput(stage, at, element.current);
  }, [stage, at]);
  if (choice === undefined) return null;
  const { panels, panel, embed } = state.value;
  return (
    <section class={`panel ${panel === at && panels.length > 1 ? "current" : ""}`} aria-label={`Panel ${at + 1}`}>
      <header>
        <PanelAlgorithm panel={at} label={`Algorithm of panel ${at + 1}`} bare />
        {!embed && <Switch label="reuse last frame" value={choice.follow}
          hint="Update the last frame's pairs for the boxes that moved, instead of searching anew"
          onChange={(follow) => changePanel(at, { follow })} />}
        {panels.length > 1 && !embed &&
          <button type="button" class="quiet" aria-label={`Close panel ${at + 1}`} onClick={() => removePanel(at)}>×</button>}
      </header>
      <div ref={element} class={`window tool-${tool.value}`} tabIndex={0} role="group"
        aria-label={`Boxes, searched by ${choice.spec}`} aria-describedby="keys-help" onKeyDown={windowKey}>
        {at === 0 && <DragHint stage={stage} />}
      </div>
      <div class="below">
        <Counts at={at} />
        {!embed && <Explanation at={at} stage={stage} window={element} />}
      </div>
      {at === 0 && <p id="keys-help" class="unseen">{keysHelp}</p>}
    </section>
  );
}

function Counts({ at }: { at: number }) {
  const result = told.value?.panels[at];
  if (result === undefined) return <div class="counts" />;
  if (result.error !== undefined) return <p class="counts error" role="alert">{result.error}</p>;
  return (
    <div class="counts">
      <dl>
        {countsOf(result).map(([name, value, hint]) => (
          <div key={name} title={hint}><dt>{name}</dt><dd data-count={name}>{value}</dd></div>
        ))}
      </dl>
      <p class="structure-caption">
        {result.late ? "Too slow for every frame: shown is an earlier one. " : ""}
        {result.outline?.caption ?? ""}
        <OneCell at={at} result={result} />
      </p>
    </div>
  );
}

/** Why `grid` shows one cell, and how it shows several. */
function OneCell({ at, result: { outline, spec } }: { at: number; result: PanelResult }) {
  const now = told.value!;
  const isGrid = nameOf(spec) === "grid";
  if ((!isGrid && outline?.caption.startsWith("grid:") !== true) || settingsOf(spec).has("cell") ||
    state.value.panels[at]?.follow !== false || outline?.levels.length !== 1 || outline.levels[0]!.length !== 2 * now.dimension)
    return null;
  const cell = String(Number(((now.bounds[now.dimension]! - now.bounds[0]!) / 20).toPrecision(2)));
  return (
    <>: the fastest for so few boxes.{" "}
      {isGrid && state.value.mode === "play" && !state.value.embed && <button type="button" onClick={() => changePanel(at, { spec: withSetting(spec, "cell", cell) })}>
        Show rows: cell={cell}</button>}</>
  );
}

function countsOf(result: PanelResult): [name: string, value: string, hint: string][] {
  const { statistics } = result;
  const follows = state.value.panels.some(({ follow }) => follow);
  return [
    ["tests", grouped(statistics.tests), "Pairs of boxes that were compared"],
    ["pairs", grouped(result.pairs), "Pairs of boxes that overlap"],
    ["references", grouped(statistics.references), "Entries of boxes in cells, nodes or lists"],
    ["time", duration(result.milliseconds), "Of a search or an update, in this browser; the median of the last frames"],
    ...(follows ? [
      ["begun, ended", result.bytes > 0 ? `${grouped(result.begun)}, ${grouped(result.ended)}` : "–",
        "Pairs that began and ended in this frame"],
      ["memory", result.bytes > 0 ? bytes(result.bytes) : "–", "What the tracker holds"],
    ] as [string, string, string][] : []),
  ];
}
