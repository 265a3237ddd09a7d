// All panels, side by side on one canvas.
import { useLayoutEffect, useRef } from "preact/hooks";

import { problem, state } from "../state/store.ts";
import { PanelView } from "./panel_view.tsx";
import type { Stage } from "./stage.ts";

export function StageView({ stage }: { stage: Stage }) {
  const element = useRef<HTMLDivElement>(null);
  const { panels } = state.value;
  useLayoutEffect(() => stage.attach(element.current!), [stage]);
  useLayoutEffect(() => stage.measure(), [stage, panels.length]);
  return (
    <>
      {problem.value !== "" && <p class="notice" role="alert">{problem.value}</p>}
      <div ref={element} class={`panels panels-${panels.length}`}>
        {panels.map((_, at) => <PanelView key={at} at={at} stage={stage} />)}
      </div>
    </>
  );
}
