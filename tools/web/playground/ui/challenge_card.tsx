// The challenge: find boxes for which `auto` chooses badly.
import { signal } from "@preact/signals";

import type { Duel } from "../bench/protocol.ts";
import { bench } from "../state/client.ts";
import { duel, duelling } from "../state/store.ts";
import { Card } from "./field.tsx";
import { duration } from "./numbers.ts";

const record = signal(0);

/** Ratios from 0.9 to 1.1 are level; those below `lost` may be noise. */
const level = 0.1;
const lost = 1.25;

function judge(ratio: number, best: string, { chosen, unsteady }: Duel): string {
  if (Math.abs(ratio - 1) <= level) return chosen === best ? `Level: auto is ${best} here.` : "Level.";
  if (chosen === best) return `Yet auto is ${best} here: the rest is its look at the boxes, or noise.`;
  if (ratio < lost && (ratio > 1 || unsteady)) return "That is too close to call.";
  if (ratio < 1) return "It won.";
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
      {result?.unsteady === true && <p class="note">The rounds differ much, since this machine is busy: small differences
        say nothing.</p>}
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
  if (ratio > record.value && result?.chosen !== best?.spec) record.value = ratio;
  return (
    <Card title="Make auto lose">
      <p class="note"><code>auto</code> looks at a sample of the boxes and chooses an algorithm. Arrange boxes for which
        another one is faster. This races it against all of the library's on the boxes that you see.</p>
      {result !== null && best !== undefined && (
        <div aria-live="polite">
          <p><b>{ratio.toFixed(2)}×</b> the time of the fastest, {best.spec}. {judge(ratio, best.spec, result)}
            {record.value > ratio ? ` Your best is ${record.value.toFixed(2)}×.` : ""}</p>
          <p class="note">{result.explanation}</p>
        </div>
      )}
      <Race />
    </Card>
  );
}
