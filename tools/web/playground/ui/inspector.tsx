// The selected box: the boxes that it was compared with, and why the others were skipped.
import { patch, state, told } from "../state/store.ts";
import { Card } from "./field.tsx";
import { grouped, plural } from "./numbers.ts";

export function Inspector() {
  const { selected, panels } = state.value;
  const now = told.value;
  if (selected < 0 || now === null) {
    return <Card title="A box's tests"><p class="note">Select a box to see which boxes it is compared with, and why
      the others are not: click it, or press N in the picture.</p></Card>;
  }
  return (
    <Card title={`Box ${selected}`}>
      {now.panels.map((result, at) => {
        const { selection } = result;
        if (selection === undefined)
          return <p key={at} class="note"><code>{result.spec}</code>: {result.unobserved ?? result.error ?? "…"}</p>;
        return (
          <div key={at} class="selection">
            {panels.length > 1 && <p><code>{result.spec}</code></p>}
            <p>Compared with <b class="tested">{plural(selection.tested.length, "box")}</b>, of which{" "}
              <b class="lit">{grouped(selection.hits)}</b> overlap it. {selection.untested.length === 0 ? "It was compared with all." : "Not compared:"}</p>
            <ul>{selection.untested.map(({ why, count }) => <li key={why}><b>{grouped(count)}</b> {why}.</li>)}</ul>
            {state.value.panels[at]?.follow && <p class="note">These are the tests of a search; following compares
              only boxes that moved.</p>}
          </div>
        );
      })}
      <button type="button" onClick={() => patch({ selected: -1 })}>Let it go</button>
    </Card>
  );
}
