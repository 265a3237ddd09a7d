// The entry "broadside": everything.
import type { Broadside, LoadOptions } from "../types/types.d.ts";
import { bytes } from "wasm:broadside";
import { broadsideOf } from "./face.ts";
import { compileInline } from "./inline.ts";

export { BroadsideError } from "./error.ts";

export async function load(options: LoadOptions = {}): Promise<Broadside> {
  return broadsideOf(await compileInline(options, bytes, () => import("./scalar.ts")));
}
