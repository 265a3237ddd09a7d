// The current panel's algorithm: its description, its tunables and the reason for auto's choice;
// and buttons for more panels.
import type { Tunable } from "../engine/types.ts";
import { maxPanels } from "../state/state.ts";
import { nameOf, settingsOf, withSetting } from "../state/spec.ts";
import { addPanel, algorithms, changePanel, state, told } from "../state/store.ts";
import { Card, Choice, Slider, Switch } from "./field.tsx";

/** The range of a slider for a tunable without bounds of its own. */
function rangeOf(tunable: Tunable, worldWidth: number): [min: number, max: number] {
  if (tunable.name === "capacity") return [Math.max(1, tunable.min ?? 1), 256];
  if (tunable.name === "cell") return [worldWidth / 400, worldWidth];
  return [Math.max(tunable.min ?? 0, -1e6), Math.min(tunable.max ?? 100, 1e6)];
}

function short(value: number): string {
  return String(Number(value.toPrecision(3)));
}

function TunableField({ tunable, spec, worldWidth, onChange }:
    { tunable: Tunable; spec: string; worldWidth: number; onChange: (spec: string) => void }) {
  const value = settingsOf(spec).get(tunable.name);
  const set = (text: string | undefined): void => onChange(withSetting(spec, tunable.name, text));
  if (tunable.type === "choice") {
    return <Choice label={tunable.name} value={value ?? tunable.default}
      options={[...new Set([tunable.default, ...(tunable.choices ?? [])])].map((one) => ({ value: one, label: one }))}
      onChange={(one) => set(one === tunable.default ? undefined : one)} />;
  }
  const [min, max] = rangeOf(tunable, worldWidth);
  const logarithmic = min > 0;
  const number = Number(value);
  const on = value !== undefined && Number.isFinite(number);
  const middle = logarithmic ? Math.sqrt(min * max) : (min + max) / 2;
  const written = (one: number): string => tunable.type === "integer" ? String(Math.round(one)) : short(one);
  return (
    <div class="tunable" title={tunable.summary}>
      <Switch label={`set ${tunable.name}`} value={on} onChange={(yes) => set(yes ? written(middle) : undefined)} />
      {on ? <Slider label={tunable.name} value={number} min={min} max={max} logarithmic={logarithmic}
        text={written} onChange={(one) => set(written(one))} hint={tunable.summary} />
        : <span class="note">{tunable.default}</span>}
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
  const bounds = told.value?.bounds;
  const worldWidth = bounds === undefined ? 100 : bounds[told.value!.dimension]! - bounds[0]!;
  // A tunable of trackers has no effect in a search.
  const tunables = (known?.tunables ?? []).filter(({ name }) =>
    !hidden.has(name) && (choice.follow || !["update", "detect"].includes(name)));
  const explanation = told.value?.panels[panel]?.explanation ?? "";
  return (
    <Card title={panels.length > 1 ? `Algorithm: panel ${panel + 1}` : "Algorithm"}>
      <p><code>{choice.spec}</code></p>
      <p class="note">{known?.summary}</p>
      {tunables.map((tunable) => (
        <TunableField key={`${known!.name}.${tunable.name}`} tunable={tunable} spec={choice.spec}
          worldWidth={worldWidth} onChange={(spec) => changePanel(panel, { spec })} />
      ))}
      {explanation !== "" && <p class="explanation">{explanation}</p>}
      <div class="row">
        <button type="button" disabled={panels.length >= maxPanels}
          onClick={() => addPanel(nextSpec())}>Add a panel</button>
        {panels.length > 1 && panels.map((one, at) => (
          <button key={at} type="button" aria-pressed={at === panel} aria-label={`Settings of panel ${at + 1}: ${one.spec}`}
            onClick={() => changeCurrent(at)}>{at + 1}</button>
        ))}
      </div>
    </Card>
  );
}

function changeCurrent(panel: number): void {
  state.value = { ...state.value, panel };
}

/** An algorithm that no panel shows. */
function nextSpec(): string {
  const taken = new Set(state.value.panels.map(({ spec }) => nameOf(spec)));
  const order = ["grid", "quadtree", "sweep_and_prune", "bvh", "auto", "brute_force"];
  return order.find((name) => !taken.has(name)) ?? "auto";
}
