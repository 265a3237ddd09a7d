// The part of Handlebars that is bundled: without the files that it reads by itself.
declare module "handlebars/dist/cjs/handlebars.js" {
  import Handlebars from "handlebars";
  export default Handlebars;
}
