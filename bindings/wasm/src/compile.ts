// Modules compiled, with an error that says what a host lacks.
import { BroadsideError, refuse } from "./error.ts";

/** Throws if the host lacks something. */
function refuseHost(lacks: string): never {
  throw new BroadsideError("FAILED", `${lacks}; expected Chrome 95, Firefox 113, Safari 16.4, Node 18 or newer`);
}

/** The bytes of a text of base64 that was compressed by gzip. */
export async function gunzip(base64: string): Promise<Uint8Array<ArrayBuffer>> {
  if (typeof DecompressionStream === "undefined") refuseHost("this host has no DecompressionStream");
  const packed = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export async function compile(bytes: BufferSource, name = "wasm"): Promise<WebAssembly.Module> {
  const start = ArrayBuffer.isView(bytes) ? new Uint8Array(bytes.buffer, bytes.byteOffset) : new Uint8Array(bytes);
  if (start[0] !== 0 || start[1] !== 0x61)
    refuse(name, bytes, "the bytes of a WebAssembly module, which begin with '\\0asm'");
  try {
    return await WebAssembly.compile(bytes);
  } catch (error) {
    return refuseHost(`this host does not compile a module with SIMD and exceptions (${String(error)})`);
  }
}
