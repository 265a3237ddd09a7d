// The entry "broadside": everything.
import type { Broadside, LoadOptions } from "../types/types.d.ts";
import { broadsideOf } from "./face.ts";
import { compileInline } from "./inline.ts";

export { BroadsideError } from "./error.ts";

export async function load(options: LoadOptions = {}): Promise<Broadside> {
  return broadsideOf(await compileInline(options, {
    "2d": () => import("module:broadside-2d"),
    "3d": () => import("module:broadside-3d"),
    "2d-scalar": () => import("module:broadside-2d-scalar"),
    "3d-scalar": () => import("module:broadside-3d-scalar"),
  }));
}
