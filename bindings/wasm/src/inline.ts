// The modules' bytes as the package carries them: compressed by zlib, as base64.
import type { LoadOptions } from "../types/types.d.ts";
import { checkOptions, refuse } from "./error.ts";
import { supportsSimd } from "./simd.ts";

async function unpacked(text: string): Promise<ArrayBuffer> {
  const packed = atob(text);
  const bytes = new Uint8Array(packed.length);
  for (let i = 0; i < packed.length; ++i) bytes[i] = packed.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

/** Compiles the module that suits this host, or the one that the options ask for. Only its bytes are fetched. */
export async function compileInline(
  options: LoadOptions, withSimd: string, withoutSimd: () => Promise<{ readonly bytes: string }>,
): Promise<WebAssembly.Module> {
  checkOptions(options, ["simd"]);
  const { simd = supportsSimd() } = options;
  if (typeof simd !== "boolean") refuse("simd", simd, "true or false");
  return WebAssembly.compile(await unpacked(simd ? withSimd : (await withoutSimd()).bytes));
}
