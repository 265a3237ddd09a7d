// BroadsideError, and the module's numbers for what went wrong.
import type { BroadsideErrorCode, Dimension } from "../types/types.d.ts";

/** By `broadside_status` of bindings/c/broadside.h. All other failures are `FAILED`. */
const codes: Readonly<Record<number, BroadsideErrorCode>> = {
  1: "INVALID_INPUT", 2: "INVALID_FRAME", 3: "INVALID_QUERY", 4: "INVALID_SPEC", 5: "INVALID_HANDLE",
  7: "INVALID_ARGUMENT", 10: "OUT_OF_MEMORY",
};

export class BroadsideError extends Error {
  /** Not what a minifier makes of it. */
  static override readonly name = "BroadsideError";
  override readonly name = "BroadsideError";
  readonly code: BroadsideErrorCode;
  readonly index: number | undefined;

  constructor(code: BroadsideErrorCode, message: string, index?: number) {
    super(message);
    this.code = code;
    this.index = index;
  }

  /** Each entry has a class of its own, and its errors are those of the others too. A derived class is as any other. */
  static override [Symbol.hasInstance](value: unknown): boolean {
    if (this !== BroadsideError) return Function.prototype[Symbol.hasInstance].call(this, value);
    return value instanceof Error && value.name === "BroadsideError";
  }
}

/** A message of the library with this language's names instead of those of C++. */
function translated(message: string): string {
  return message.replace(/WorldOptions::|, first_generation/g, "").replace("unknown tunable", "unknown option")
    .replace("find_pairs()", "broadside.pairs(boxes)").replace(/_([a-z])/g, (_, letter: string) => letter.toUpperCase());
}

export function errorOf(status: number, message: string, index: number): BroadsideError {
  const code = codes[status] ?? "FAILED";
  if (code === "INVALID_INPUT" && message.includes("min <= max") && !message.includes("nan"))
    message += "; a box is its minima and then its maxima, not its size";
  // A spec is written as in C++.
  return new BroadsideError(code, code === "INVALID_SPEC" ? message : translated(message),
    code === "INVALID_INPUT" ? index : undefined);
}

/** What a value is, for messages. */
function described(value: unknown): string {
  if (value === null || value === undefined) return String(value);
  if (typeof value === "string") return `'${value}'`;
  if (typeof value === "function") return "a function";
  if (typeof value === "object") {
    const kind = Object.prototype.toString.call(value).slice(8, -1);
    return kind === "Object" ? "an object" : kind === "Array" ? "an array" : kind;
  }
  return String(value);
}

/** Refuses an argument. */
export function refuse(name: string, value: unknown, expected: string): never {
  throw new BroadsideError("INVALID_ARGUMENT", `${name} is ${described(value)}; expected ${expected}`);
}

/** Refuses options other than these. */
export function checkOptions(options: object, known: readonly string[], name = "options"): void {
  if (typeof options !== "object" || options === null) refuse(name, options, `an object of ${known.join(", ")}`);
  for (const option in options) {
    if (!known.includes(option)) {
      const meant = option && known.find((name) => name.startsWith(option) || option.startsWith(name));
      throw new BroadsideError("INVALID_ARGUMENT", `unknown option '${option}'${meant ? ` (did you mean '${meant}'?)` : ""}` +
        `; expected ${known.length === 0 ? "none" : `some of: ${known.join(", ")}`}`);
    }
  }
}

/** Refuses an option that is given and neither true nor false. */
export function checkSwitch(name: string, value: unknown): void {
  if (value !== undefined && typeof value !== "boolean") refuse(name, value, "true or false");
}

/** Whether options ask for a view of the module's memory rather than a copy. */
export function asksForView(options: { readonly view?: unknown }): boolean {
  const { view = false } = options;
  return typeof view === "boolean" ? view : refuse("view", view, "true or false");
}

export function checkDimension(dimension: unknown): asserts dimension is Dimension {
  if (dimension !== 2 && dimension !== 3) refuse("dimension", dimension, "2 or 3");
}
