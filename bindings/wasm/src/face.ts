// The face of the modules with everything.
import type {
  BoxArray, Broadside, Dimension, Filters, Index, QueriedWorld, WorldOptions,
} from "../types/types.d.ts";
import { Cores } from "./core.ts";
import { PairFindingFace } from "./face_of_pairs.ts";
import { AskedWorld, KeptIndex } from "./queries.ts";

class BroadsideFace extends PairFindingFace implements Broadside {
  override world(options?: WorldOptions): QueriedWorld {
    return new AskedWorld(this.cores, options);
  }

  index(boxes: BoxArray, options?: { readonly dimension?: Dimension; readonly filters?: Filters }): Index {
    return new KeptIndex(this.cores, boxes, options);
  }
}

export async function broadsideOf(wasms: readonly WebAssembly.Module[]): Promise<Broadside> {
  return new BroadsideFace(await Cores.make(wasms));
}
