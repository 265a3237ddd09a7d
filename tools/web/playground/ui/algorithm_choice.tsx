// Chooses a panel's algorithm.
import type { Dimension } from "../scene/scene.ts";
import { algorithms } from "../state/store.ts";
import { nameOf } from "../state/spec.ts";
import { Choice } from "./field.tsx";

const groups: Record<string, string> = { own: "The library", paper: "The draft's listings" };

export function AlgorithmChoice({ spec, dimension, label, onChange }:
    { spec: string; dimension: Dimension; label: string; onChange: (spec: string) => void }) {
  const known = algorithms.value.filter(({ dimensions }) => dimensions.includes(dimension));
  const name = nameOf(spec);
  const options = known.map((one) =>
    ({ value: one.name, label: one.name, group: groups[one.kind] ?? one.kind }));
  // An algorithm that does not support the scene's dimension stays listed, with its search's error
  // beside it.
  if (!options.some(({ value }) => value === name)) options.unshift({ value: name, label: name, group: "Chosen" });
  return <Choice label={label} value={name} options={options} onChange={onChange} bare />;
}
