// Chooses a panel's algorithm.
import { algorithms, changePanel, dimension, state } from "../state/store.ts";
import { nameOf } from "../state/spec.ts";
import { Choice } from "./field.tsx";

const groups: Record<string, string> = { own: "In the library", paper: "As listed in the paper" };

export function PanelAlgorithm({ panel, label, bare = false }: { panel: number; label: string; bare?: boolean }) {
  const name = nameOf(state.value.panels[panel]?.spec ?? "");
  const options = algorithms.value.filter(({ dimensions }) => dimensions.includes(dimension.value)).map((one) =>
    ({ value: one.name, label: one.name, group: groups[one.kind] ?? one.kind }));
  // An algorithm that does not support the scene's dimension stays listed, with its search's error
  // beside it.
  if (!options.some(({ value }) => value === name))
    options.unshift({ value: name, label: name === "" ? "choose one …" : name, group: "Chosen" });
  return <Choice label={label} value={name} options={options} bare={bare}
    onChange={(spec) => changePanel(panel, { spec })} />;
}
