// The modules that the package carries in files of their own, compressed.
import type { Dimension, LoadOptions } from "../types/types.d.ts";
import { compile, gunzip } from "./compile.ts";
import { checkDimension, checkOptions } from "./error.ts";

/** Imports the bytes of an entry's module for each dimension. */
export type Modules = Readonly<Record<Dimension, () => Promise<{ readonly default: string }>>>;

/** Compiles the modules that the options ask for. Only their bytes are fetched, at the same time. */
export async function compileInline(options: LoadOptions, modules: Modules): Promise<WebAssembly.Module[]> {
  checkOptions(options, ["dimension"]);
  const { dimension } = options;
  if (dimension !== undefined) checkDimension(dimension);
  const compileOne = async (of: Dimension) => compile(await gunzip((await modules[of]()).default));
  return Promise.all(dimension === undefined ? [compileOne(2), compileOne(3)] : [compileOne(dimension)]);
}
