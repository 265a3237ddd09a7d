// The entry "broadside/pairs": pairs, trackers and worlds.
import type { LoadOptions, PairFinding } from "../types/types.d.ts";
import { pairFindingOf } from "./face_of_pairs.ts";
import { compileInline } from "./inline.ts";

export { BroadsideError } from "./error.ts";

export async function load(options: LoadOptions = {}): Promise<PairFinding> {
  return pairFindingOf(await compileInline(options, {
    2: () => import("module:broadside-pairs-2d"),
    3: () => import("module:broadside-pairs-3d"),
  }));
}
