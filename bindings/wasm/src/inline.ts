// The modules' bytes as the package carries them: compressed by LZMA, as base64.
import unpacker from "unpacker";

import type { Dimension, LoadOptions } from "../types/types.d.ts";
import { checkDimension, checkOptions, refuse } from "./error.ts";
import { supportsSimd } from "./simd.ts";

/** What the module exports that decompresses the others: module/unpack.cpp. */
interface Unpacker {
  readonly memory: WebAssembly.Memory;
  room(): number;
  unpack(packedSize: number, size: number): void;
}

interface Packed {
  readonly size: number;
  readonly bytes: string;
}

const bytesIn = (base64: string) => Uint8Array.from(atob(base64), (byte) => byte.charCodeAt(0));

async function unpacked({ size, bytes }: Packed): Promise<Uint8Array<ArrayBuffer>> {
  const packed = bytesIn(bytes);
  const { instance } = await WebAssembly.instantiate(bytesIn(unpacker));
  const { memory, room, unpack } = instance.exports as unknown as Unpacker;
  memory.grow(Math.ceil((packed.length + size) / 65536));
  new Uint8Array(memory.buffer).set(packed, room());
  unpack(packed.length, size);
  return new Uint8Array(memory.buffer as ArrayBuffer, room() + packed.length, size);
}

/** Imports a module's bytes. */
type Import = () => Promise<Packed>;

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
    WebAssembly.compile(await unpacked(await modules[`${of}d${simd ? "" : "-scalar"}`]()));
  return Promise.all(dimension === undefined ? [compile(2), compile(3)] : [compile(dimension)]);
}
