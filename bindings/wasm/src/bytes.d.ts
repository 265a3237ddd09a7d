// What build.mjs makes of a module's bytes: a file for each, which is fetched when it is needed.
declare module "module:*" {
  export const size: number;
  export const bytes: string;
}

/** In base64, the module that decompresses the others: module/unpack.cpp. */
declare module "unpacker" {
  const base64: string;
  export default base64;
}
