// What build.mjs makes of a module's bytes: a file for each, which is fetched when it is needed.
declare module "module:*" {
  export const bytes: string;
}
