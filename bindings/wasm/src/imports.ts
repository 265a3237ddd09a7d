// What the module takes of JavaScript: numbers read and written, and the memory's growth, which needs nothing.

/** A number as C's `%.*g` writes it; with no `digits`, the shortest text that reads back to it. */
export function numberText(value: number, digits: number): string {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "nan" : value < 0 ? "-inf" : "inf";
  const rounded = digits === 0 ? value : Number(value.toPrecision(digits));
  const [mantissa, power] = rounded.toExponential().split("e") as [string, string];
  const exponent = Number(power);
  const scientific = `${mantissa}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
  const plain = String(rounded);
  if (plain.includes("e")) return scientific;
  const isScientific = digits === 0 ? scientific.length < plain.length : exponent < -4 || exponent >= digits;
  return isScientific ? scientific : plain;
}

/** The number that a text is from end to end, or NaN. */
export function numberIn(text: string): number {
  return /^-?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text) ? Number(text) : /^-?inf(inity)?$/i.test(text) ?
    Number(text.replace(/inf.*/i, "Infinity")) : NaN;
}

/** `memory` gives the module's memory, which there is not yet. */
export function importsOf(memory: () => ArrayBufferLike): WebAssembly.Imports {
  const text = (address: number, size: number) =>
    String.fromCharCode(...new Uint8Array(memory(), address, size));
  return {
    js: {
      write_number(value: number, digits: number, address: number): number {
        const written = numberText(value, digits);
        const bytes = new Uint8Array(memory(), address);
        for (let i = 0; i < written.length; ++i) bytes[i] = written.charCodeAt(i);
        return written.length;
      },
      read_number: (address: number, size: number): number => numberIn(text(address, size)),
    },
    env: { emscripten_notify_memory_growth() {} },
    // Called where C++ gives up, which it does only if an exception leaves a destructor.
    wasi_snapshot_preview1: {
      proc_exit(code: number): never {
        throw new Error(`the module ended with ${code}`);
      },
    },
  };
}
