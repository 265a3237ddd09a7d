// build.mjs makes a file of each module's bytes, which is fetched when it is needed.
declare module "module:*" {
  export const size: number;
  export const bytes: string;
}

/** The module that decompresses the others, module/unpack.cpp, in base64. */
declare module "unpacker" {
  const base64: string;
  export default base64;
}
