// The page's controls, each with its label and current value.
import type { ComponentChildren } from "preact";
import { useId } from "preact/hooks";

interface SliderProps {
  label: string;
  value: number;
  min: number;
  max: number;
  /** Steps of the slider; on a logarithmic one, steps of the logarithm. */
  step?: number;
  logarithmic?: boolean;
  /** The value as text. */
  text?: (value: number) => string;
  onChange: (value: number) => void;
  hint?: string | undefined;
}

export function Slider({ label, value, min, max, step, logarithmic = false, text, onChange, hint }: SliderProps) {
  const id = useId();
  const inward = (one: number): number => logarithmic ? Math.log10(one) : one;
  const outward = (one: number): number => logarithmic ? 10 ** one : one;
  const said = (text ?? String)(value);
  return (
    <div class="field">
      <label for={id}>{label}</label>
      <output for={id}>{said}</output>
      <input id={id} type="range" min={inward(min)} max={inward(max)} title={hint}
        step={step ?? (inward(max) - inward(min)) / 200} value={inward(Math.max(min, value))} aria-valuetext={said}
        onInput={(event) => onChange(outward(event.currentTarget.valueAsNumber))} />
    </div>
  );
}

interface ChoiceProps {
  label: string;
  value: string;
  options: readonly { value: string; label: string; group?: string }[];
  onChange: (value: string) => void;
  /** Whether the label is only for screen readers. */
  bare?: boolean;
  class?: string;
}

export function Choice({ label, value, options, onChange, bare = false, class: name = "" }: ChoiceProps) {
  const id = useId();
  const groups = [...new Set(options.map(({ group }) => group))];
  const list = (group: string | undefined) => options.filter((one) => one.group === group).map((one) =>
    <option key={one.value} value={one.value} selected={one.value === value}>{one.label}</option>);
  return (
    <div class={`field choice ${name}`}>
      <label for={id} class={bare ? "unseen" : ""}>{label}</label>
      <select id={id} value={value} onChange={(event) => onChange(event.currentTarget.value)}>
        {groups.map((group) => group === undefined ? list(group) : <optgroup key={group} label={group}>{list(group)}</optgroup>)}
      </select>
    </div>
  );
}

interface SwitchProps {
  label: ComponentChildren;
  value: boolean;
  onChange: (value: boolean) => void;
  hint?: string;
}

export function Switch({ label, value, onChange, hint }: SwitchProps) {
  return (
    <label class="switch" title={hint}>
      <input type="checkbox" checked={value} onChange={(event) => onChange(event.currentTarget.checked)} />
      {label}
    </label>
  );
}

interface ButtonsProps<Value extends string> {
  label: string;
  value: Value;
  options: readonly { value: Value; label: string; hint?: string }[];
  onChange: (value: Value) => void;
}

/** A few mutually exclusive choices. */
export function Buttons<Value extends string>({ label, value, options, onChange }: ButtonsProps<Value>) {
  return (
    <div class="buttons" role="group" aria-label={label}>
      {options.map((one) => (
        <button key={one.value} type="button" title={one.hint} aria-pressed={one.value === value}
          onClick={() => onChange(one.value)}>{one.label}</button>
      ))}
    </div>
  );
}

export function Card({ title, children, open = true, class: name = "" }:
    { title: string; children: ComponentChildren; open?: boolean; class?: string }) {
  return (
    <details class={`card ${name}`} open={open}>
      <summary><h2>{title}</h2></summary>
      <div class="inside">{children}</div>
    </details>
  );
}
