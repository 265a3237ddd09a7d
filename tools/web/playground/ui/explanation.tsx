// The selected box, explained in the picture: the boxes that it was compared with, and why the others
// were not.
import { useSignalEffect } from "@preact/signals";
import type { RefObject } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";

import { patch, shown, state, told } from "../state/store.ts";
import { grouped, plural } from "./numbers.ts";
import type { Stage } from "./stage.ts";
import { camera } from "./view.ts";

/** Pixels between the explanation and the picture's border. */
const space = 8;

interface Props {
  at: number;
  stage: Stage;
  window: RefObject<HTMLElement | null>;
}

export function Explanation({ at, stage, window }: Props) {
  const element = useRef<HTMLElement>(null);
  const { selected, panels } = state.value;
  // At the side of the picture away from the box, so that the middle stays free. On a narrow page,
  // the style sheet puts it below the picture.
  const place = (): void => {
    void [shown.value, camera.value, stage.layout.value];
    const [note, around] = [element.current, window.current];
    const box = stage.rectangle(at, state.value.selected);
    if (note === null || around === null || box === undefined) return;
    const isLeft = box.x + box.width / 2 < around.clientWidth / 2;
    const x = isLeft ? around.clientWidth - note.offsetWidth - space : space;
    note.style.transform =
      `translate(${Math.round(around.offsetLeft + Math.max(0, x))}px, ${around.offsetTop + space}px)`;
  };
  useSignalEffect(place);
  useLayoutEffect(place);
  const result = told.value?.panels[at];
  if (selected < 0 || result === undefined) return null;
  const { selection } = result;
  return (
    <section ref={element} class="explanation-note" aria-label={`Box ${selected}, by ${result.spec}`}>
      <header>
        <h2>Box {selected}</h2>
        <button type="button" class="quiet" aria-label="Deselect the box" onClick={() => patch({ selected: -1 })}>×</button>
      </header>
      {selection === undefined ? <p class="note">{result.unobserved ?? result.error ?? "…"}</p> : (
        <div class="selection">
          <p>Compared with <b class="tested">{plural(selection.tested.length, "box")}</b>; overlaps{" "}
            <b class="lit">{grouped(selection.hits)}</b> of them.{" "}
            {selection.untested.length === 0 ? "No box was left out." : "Not compared:"}</p>
          <ul>{selection.untested.map(({ why, count }) => <li key={why}><b>{grouped(count)}</b> {why}.</li>)}</ul>
          {panels[at]?.follow && <p class="note">These are the tests of a search from scratch. This panel reuses
            the last frame's pairs, and compares only boxes that moved.</p>}
        </div>
      )}
    </section>
  );
}
