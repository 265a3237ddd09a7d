// The entry "broadside/external": everything, over modules that the caller brings.
import type { Broadside } from "../types/types.d.ts";
import type { ExternalOptions, ModuleSource } from "../types/external.d.ts";
import { compile } from "./compile.ts";
import { checkOptions, refuse } from "./error.ts";
import { broadsideOf } from "./face.ts";

export { BroadsideError } from "./error.ts";

async function compiled(source: ModuleSource): Promise<WebAssembly.Module> {
  const wasm = await source;
  if (wasm instanceof WebAssembly.Module) return wasm;
  if (typeof wasm === "string" || wasm instanceof URL) return compiled(await fetch(wasm));
  if (typeof Response !== "undefined" && wasm instanceof Response) {
    if (!wasm.ok) refuse("the response's status", wasm.status, "200");
    return compile(await wasm.arrayBuffer());
  }
  if (wasm instanceof ArrayBuffer || ArrayBuffer.isView(wasm)) return compile(wasm);
  return refuse("wasm", wasm, "a WebAssembly.Module, its bytes, a Response, or its address");
}

export async function load(options: ExternalOptions): Promise<Broadside> {
  checkOptions(options, ["wasm"]);
  const { wasm } = options;
  return broadsideOf(await Promise.all((Array.isArray(wasm) ? wasm : [wasm]).map(compiled)));
}
