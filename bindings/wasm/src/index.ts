// The entry "broadside": everything.
import type { Broadside, LoadOptions } from "../types/types.d.ts";
import { broadsideOf } from "./face.ts";
import { compileInline } from "./inline.ts";

export { BroadsideError } from "./error.ts";

export async function load(options: LoadOptions = {}): Promise<Broadside> {
  return broadsideOf(await compileInline(options, {
    2: () => import("module:broadside-2d"),
    3: () => import("module:broadside-3d"),
  }));
}
