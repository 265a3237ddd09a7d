// The selected box, explained beside it: the boxes that it was compared with, and why the others
// were not.
import { useSignalEffect } from "@preact/signals";
import type { RefObject } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";

import { patch, shown, state, told } from "../state/store.ts";
import { between, grouped, plural } from "./numbers.ts";
import type { Stage } from "./stage.ts";
import { camera } from "./view.ts";

/** Pixels between a box and its explanation. */
const space = 14;

interface Props {
  at: number;
  stage: Stage;
  window: RefObject<HTMLElement | null>;
}

export function Explanation({ at, stage, window }: Props) {
  const element = useRef<HTMLElement>(null);
  const { selected, panels } = state.value;
  // To the right of the box or, without room there, to its left. On a narrow page, the style sheet
  // puts it below the picture.
  const place = (): void => {
    void [shown.value, camera.value, stage.layout.value];
    const [note, around] = [element.current, window.current];
    const box = stage.rectangle(at, state.value.selected);
    if (note === null || around === null || box === undefined) return;
    const right = box.x + box.width + space;
    const x = right + note.offsetWidth <= around.clientWidth ? right : box.x - space - note.offsetWidth;
    const y = box.y + (box.height - note.offsetHeight) / 2;
    note.style.transform =
      `translate(${Math.round(around.offsetLeft + between(x, 0, around.clientWidth - note.offsetWidth))}px, ` +
      `${Math.round(around.offsetTop + between(y, 0, around.clientHeight - note.offsetHeight))}px)`;
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
