// The challenge: find boxes for which `auto` chooses badly.
import { signal } from "@preact/signals";

import { bench } from "../state/client.ts";
import { duel, duelling } from "../state/store.ts";
import { Card } from "./field.tsx";
import { duration } from "./numbers.ts";

const record = signal(0);

/** Ratios below this may be noise. */
const lost = 1.25;

function judge(ratio: number): string {
  if (ratio < 1.02) return "It won.";
  if (ratio < lost) return "That is too close to call.";
  return ratio < 2 ? "It lost. Can you make it worse?" : "It lost badly. Copy the link and report it: it is worth a bug.";
}

/** A race of `auto` against the library's other algorithms on the boxes shown, and its times. */
export function Race() {
  const result = duel.value;
  return (
    <>
      <button type="button" disabled={duelling.value} onClick={() => {
        duelling.value = true;
        bench().send({ kind: "duel" });
      }}>{duelling.value ? "Racing …" : "Race"}</button>
      {result !== null && (
        <table>
          <caption class="unseen">Time of a search by each algorithm</caption>
          <tbody>
            <tr><th scope="row">auto</th><td>{duration(result.auto)}</td></tr>
            {result.others.map(({ spec, milliseconds }) =>
              <tr key={spec}><th scope="row">{spec}</th><td>{duration(milliseconds)}</td></tr>)}
          </tbody>
        </table>
      )}
    </>
  );
}

export function ChallengeCard() {
  const result = duel.value;
  const best = result?.others[0];
  const ratio = result === null || best === undefined ? NaN : result.auto / best.milliseconds;
  if (ratio > record.value) record.value = ratio;
  return (
    <Card title="Make auto lose">
      <p class="note"><code>auto</code> looks at a sample of the boxes and chooses an algorithm. Arrange boxes for which
        another one is faster. This races it against all of the library's on the boxes that you see.</p>
      {result !== null && best !== undefined && (
        <div aria-live="polite">
          <p><b>{ratio.toFixed(2)}×</b> the time of the fastest, {best.spec}. {judge(ratio)}
            {record.value > ratio ? ` Your best is ${record.value.toFixed(2)}×.` : ""}</p>
          <p class="note">{result.explanation}</p>
        </div>
      )}
      <Race />
    </Card>
  );
}
