// The entry "broadside/external": everything, over modules that the caller brings.
import type { Broadside } from "../types/types.d.ts";
import type { ExternalOptions, ModuleSource } from "../types/external.d.ts";
import { compile } from "./compile.ts";
import { BroadsideError, checkOptions, refuse } from "./error.ts";
import { broadsideOf } from "./face.ts";

export { BroadsideError } from "./error.ts";

async function compiled(source: ModuleSource): Promise<WebAssembly.Module> {
  const wasm = await source;
  if (wasm instanceof WebAssembly.Module) return wasm;
  if (typeof wasm === "string" || wasm instanceof URL) return compiled(await fetched(wasm));
  if (typeof Response !== "undefined" && wasm instanceof Response) {
    if (!wasm.ok) refuse(`the status of ${wasm.url || "the response"}`, wasm.status, `200, from ${address}`);
    return compile(await wasm.arrayBuffer(), wasm.url || "wasm");
  }
  if (wasm instanceof ArrayBuffer || ArrayBuffer.isView(wasm)) return compile(wasm);
  return refuse("wasm", wasm, "a WebAssembly.Module, its bytes, a Response, or its address");
}

const address = 'the address of a file of the package, such as "broadside/broadside-2d.wasm?url" is in Vite';

async function fetched(url: URL | string): Promise<Response> {
  try {
    return await fetch(url);
  } catch (error) {
    throw new BroadsideError("FAILED", `${url} could not be fetched (${String(error)}); expected ${address}`);
  }
}

export async function load(options: ExternalOptions): Promise<Broadside> {
  checkOptions(options, ["wasm"]);
  const { wasm } = options;
  return broadsideOf(await Promise.all((Array.isArray(wasm) ? wasm : [wasm]).map(compiled)));
}
