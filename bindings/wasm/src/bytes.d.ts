// What build.mjs makes of a module's bytes.
declare module "wasm:*" {
  export const bytes: string;
}
