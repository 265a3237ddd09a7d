// The summary at the top: what was done, where, and the result.
import type { Build, Machine } from "../charts/data.ts";
import { bytesText, grouped } from "../charts/numbers.ts";
import { el } from "./dom.ts";

/** A highlighted figure. */
export function tile(name: string, big: string, small = ""): HTMLElement {
  return el("div", { class: "tile" }, el("dt", {}, name), el("dd", { class: "big" }, big), small !== "" && el("dd", { class: "small" }, small));
}

/** Reasons to doubt the times of a run: the machine was busy, or some times vary too much. */
export interface Doubts {
  busy: boolean | null;
  processorShare: number | null;
  unsteady: number;
  measurements: number;
}

/** A notice of the doubts, for the top of the page; null if there are none. */
export function doubtsNotice({ busy, processorShare, unsteady, measurements }: Doubts): HTMLElement | null {
  const others = processorShare === null ? "for part of this run" : `for ${Math.round(100 * (1 - processorShare))} % of this run`;
  const doubts: [string, string][] = [];
  if (busy === true) doubts.push(["Busy machine.", `Other programs had the processor ${others}, so times are too long, and not all by the same factor.`]);
  if (unsteady > 0) doubts.push(["Unsteady times.", `${grouped(unsteady)} of ${grouped(measurements)} measurements vary so much that their median cannot be trusted.`]);
  if (doubts.length === 0) return null;
  return el("div", { class: `notice ${busy === true ? "bad" : "fair"}`, role: "note", "aria-label": "Doubtful times" },
    ...doubts.map(([name, text]) => el("p", {}, el("strong", {}, name), ` ${text}`)),
    el("p", {}, "Quiet the machine and measure again before you quote these times."));
}

function commandText(command: readonly string[]): string {
  const quoted = (word: string): string => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
  return command.map((word, i) => quoted(i === 0 ? word.replace(/^.*\//, "") : word)).join(" ");
}

/** Machine, build, date and command. */
export function facts(of: { machine: Machine; build: Build; command: string[]; date: string; target: string | null }): HTMLElement {
  const { machine, build } = of;
  const cores = machine.cores === null ? "" : `, ${machine.cores} ${machine.cores === 1 ? "core" : "cores"}`;
  const all: [string, string | Node][] = [
    ["Machine", (machine.cpu ?? "unknown processor") + cores],
    ["Memory", machine.memory_bytes === null ? "" : bytesText(machine.memory_bytes)],
    ["System", machine.os ?? ""],
    ["Build", `Broadside ${build.version}${build.revision === null ? "" : ` (${build.revision})`}, ${build.compiler}`],
    ["Flags", [build.type, build.flags].filter((part) => part !== null && part !== "").join(": ")],
    ["Instruction set", of.target ?? ""],
    ["Date", of.date],
    ["Command", el("code", {}, commandText(of.command))],
  ];
  return el("dl", { class: "facts" },
    ...all.filter(([, value]) => value !== "").flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)]));
}
