// All panels, side by side on one canvas.
import { useLayoutEffect, useRef } from "preact/hooks";

import { problem, state } from "../state/store.ts";
import { FileAdvice } from "./file_advice.tsx";
import { PanelView } from "./panel_view.tsx";
import type { Stage } from "./stage.ts";

/** The page's error, and what can be done about it. */
export function Notice() {
  if (problem.value === "") return null;
  return (
    <div class="notice" role="alert">
      <FileAdvice text={problem.value} />
      <button type="button" class="quiet" aria-label="Dismiss the error" onClick={() => { problem.value = ""; }}>×</button>
    </div>
  );
}

export function StageView({ stage }: { stage: Stage }) {
  const element = useRef<HTMLDivElement>(null);
  const { panels } = state.value;
  useLayoutEffect(() => stage.attach(element.current!), [stage]);
  useLayoutEffect(() => stage.measure(), [stage, panels.length]);
  return (
    <>
      <Notice />
      <div ref={element} class={`panels panels-${panels.length}`}>
        {panels.map((_, at) => <PanelView key={at} at={at} stage={stage} />)}
      </div>
    </>
  );
}
