// The modules' bytes as the package carries them: compressed by zlib, as base64.
import type { Dimension, LoadOptions } from "../types/types.d.ts";
import { checkDimension, checkOptions, refuse } from "./error.ts";
import { supportsSimd } from "./simd.ts";

async function unpacked(text: string): Promise<ArrayBuffer> {
  const packed = atob(text);
  const bytes = new Uint8Array(packed.length);
  for (let i = 0; i < packed.length; ++i) bytes[i] = packed.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

/** Imports a module's bytes. */
type Import = () => Promise<{ readonly bytes: string }>;

/** The modules of an entry by their dimension, with SIMD and without. */
export type Modules = Readonly<Record<`${Dimension}d${"" | "-scalar"}`, Import>>;

/**
 * Compiles the modules that suit this host, or that the options ask for: one for each dimension. Only their bytes are
 * fetched, at the same time.
 */
export async function compileInline(options: LoadOptions, modules: Modules): Promise<WebAssembly.Module[]> {
  checkOptions(options, ["simd", "dimension"]);
  const { simd = supportsSimd(), dimension } = options;
  if (typeof simd !== "boolean") refuse("simd", simd, "true or false");
  if (dimension !== undefined) checkDimension(dimension);
  const compile = async (of: Dimension) =>
    WebAssembly.compile(await unpacked((await modules[`${of}d${simd ? "" : "-scalar"}`]()).bytes));
  return Promise.all(dimension === undefined ? [compile(2), compile(3)] : [compile(dimension)]);
}
