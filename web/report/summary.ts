// What a reader wants to know first: what was done, where, and what came of it.
import type { Build, Machine } from "../charts/data.ts";
import { bytes_text, grouped } from "../charts/numbers.ts";
import { el } from "./dom.ts";

/** A figure that stands out. */
export function tile(name: string, big: string, small = ""): HTMLElement {
  return el("div", { class: "tile" }, el("dt", {}, name), el("dd", { class: "big" }, big), small !== "" && el("dd", { class: "small" }, small));
}

/** A tile that says how many times are not to be trusted; none where all are. */
export function unsteady_tile(unsteady: number, measurements: number): HTMLElement | false {
  return unsteady > 0 && tile("Unsteady", `${grouped(unsteady)} of ${grouped(measurements)}`,
    "measurements, whose median sample is far above the least: quiet the machine and measure again");
}

function command_text(command: readonly string[]): string {
  const quoted = (word: string): string => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
  return command.map((word, i) => quoted(i === 0 ? word.replace(/^.*\//, "") : word)).join(" ");
}

/** Machine, build, date and command. */
export function facts(of: { machine: Machine; build: Build; command: string[]; date: string; target: string | null }): HTMLElement {
  const { machine, build } = of;
  const cores = machine.cores === null ? "" : `, ${machine.cores} ${machine.cores === 1 ? "core" : "cores"}`;
  const all: [string, string | Node][] = [
    ["Machine", (machine.cpu ?? "unknown processor") + cores],
    ["Memory", machine.memory_bytes === null ? "" : bytes_text(machine.memory_bytes)],
    ["System", machine.os ?? ""],
    ["Build", `Broadside ${build.version}${build.revision === null ? "" : ` (${build.revision})`}, ${build.compiler}`],
    ["Flags", [build.type, build.flags].filter((part) => part !== null && part !== "").join(": ")],
    ["Instruction set", of.target ?? ""],
    ["Date", of.date],
    ["Command", el("code", {}, command_text(of.command))],
  ];
  return el("dl", { class: "facts" },
    ...all.filter(([, value]) => value !== "").flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)]));
}
