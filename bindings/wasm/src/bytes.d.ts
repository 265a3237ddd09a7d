// build.mjs makes a file of each module's bytes, which is fetched when it is needed: compressed by gzip, as base64.
declare module "module:*" {
  const gzipped: string;
  export default gzipped;
}
