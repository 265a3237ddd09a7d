// The current panel's algorithm: its description, its tunables and the reason for auto's choice.
import type { Tunable } from "../engine/types.ts";
import { nameOf, settingsOf, withSetting } from "../state/spec.ts";
import { algorithms, changePanel, dimension, patch, state, told } from "../state/store.ts";
import { Card, Choice, Slider, Switch } from "./field.tsx";

/** The range of a slider for a tunable without bounds of its own. */
function rangeOf(tunable: Tunable, worldWidth: number): [min: number, max: number] {
  if (tunable.name === "capacity") return [Math.max(1, tunable.min ?? 1), 256];
  if (tunable.name === "cell") return [worldWidth / 400, worldWidth];
  return [Math.max(tunable.min ?? 0, -1e6), Math.min(tunable.max ?? 100, 1e6)];
}

function tunablesOf(spec: string): readonly Tunable[] {
  return algorithms.value.find(({ name }) => name === nameOf(spec))?.tunables ?? [];
}

function short(value: number): string {
  return String(Number(value.toPrecision(3)));
}

/**
 * A tunable of a panel's algorithm; nothing if the algorithm has none of that name. With `of`, that of this spec if the
 * panel has another algorithm.
 */
export function TunableField({ panel, name, of }: { panel: number; name: string; of?: string }) {
  const current = (): string => {
    const { spec } = state.value.panels[panel]!;
    return of === undefined || nameOf(spec) === nameOf(of) ? spec : of;
  };
  const spec = current();
  const tunable = tunablesOf(spec).find((one) => one.name === name);
  if (tunable === undefined) return null;
  const bounds = told.value?.bounds;
  const worldWidth = bounds === undefined ? 100 : bounds[told.value!.dimension]! - bounds[0]!;
  const value = settingsOf(spec).get(name);
  const set = (text: string | undefined): void => changePanel(panel, { spec: withSetting(current(), name, text) });
  if (tunable.type === "choice") {
    return <Choice label={tunable.name} value={value ?? tunable.default}
      options={[...new Set([tunable.default, ...(tunable.choices ?? [])])].filter((one) => one !== "z" || dimension.value === 3)
        .map((one) => ({ value: one, label: one }))}
      onChange={(one) => set(one === tunable.default ? undefined : one)} />;
  }
  const [min, max] = rangeOf(tunable, worldWidth);
  const logarithmic = min > 0;
  const number = Number(value);
  const on = value !== undefined && Number.isFinite(number);
  const middle = logarithmic ? Math.sqrt(min * max) : (min + max) / 2;
  const written = (one: number): string => tunable.type === "integer" ? String(Math.round(one)) : short(one);
  return (
    <div class="tunable">
      {on && <Slider label={name} value={number} min={min} max={max} logarithmic={logarithmic}
        text={written} onChange={(one) => set(written(one))} hint={tunable.summary} />}
      <Switch label={<>choose <code>{name}</code> by hand{!on && ` (now ${tunable.default})`}</>} value={on}
        onChange={(yes) => set(yes ? written(middle) : undefined)} />
      <p class="note">{tunable.summary}</p>
    </div>
  );
}

/**
 * Threads need shared memory, which a page from a folder does not have; the declared world is the
 * bounds.
 */
const hidden = new Set(["threads", "left", "top", "width", "height", "reinsert"]);

export function AlgorithmCard() {
  const { panels, panel } = state.value;
  const choice = panels[panel] ?? panels[0]!;
  const known = algorithms.value.find(({ name }) => name === nameOf(choice.spec));
  // A tunable of trackers has no effect in a search.
  const tunables = tunablesOf(choice.spec).filter(({ name }) =>
    !hidden.has(name) && (choice.follow || !["update", "detect"].includes(name)));
  const explanation = told.value?.panels[panel]?.explanation ?? "";
  return (
    <Card title={panels.length > 1 ? `Algorithm ${panel + 1} of ${panels.length}` : "Algorithm"}>
      {panels.length > 1 && <div class="row" role="group" aria-label="Algorithm to adjust">{panels.map((one, at) => (
        <button key={at} type="button" aria-pressed={at === panel} onClick={() => patch({ panel: at })}>
          {at + 1}: {nameOf(one.spec)}</button>
      ))}</div>}
      <p><code>{choice.spec}</code></p>
      <p class="note">{known?.summary}</p>
      {tunables.map(({ name }) => <TunableField key={`${known!.name}.${name}`} panel={panel} name={name} />)}
      {explanation !== "" && <p class="explanation">{explanation}</p>}
    </Card>
  );
}

