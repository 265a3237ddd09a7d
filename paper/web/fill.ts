// Fills templates by Handlebars in strict mode. A name that is not there is an error that says which there are.
import Handlebars from "handlebars/dist/cjs/handlebars.js";

import { listed, Problem } from "./problem.ts";

export interface Template {
  /** As errors name it. */
  file: string;
  text: string;
}

/** What a template may name: texts and numbers by path, and helpers, which are called with texts. */
export interface Names {
  data: Record<string, unknown>;
  helpers: Record<string, (...words: string[]) => string | boolean>;
}

type Node = hbs.AST.Node;

/** Whether a node calls: has words after its name, or names a helper. */
interface Call extends Node {
  path: hbs.AST.PathExpression;
  params: hbs.AST.Expression[];
  hash?: hbs.AST.Hash;
}

const blocks = ["if", "unless"];

/** Parses a template. Throws Problem. */
export function parsed(template: Template): hbs.AST.Program {
  try {
    return Handlebars.parse(template.text);
  } catch (error) {
    throw new Problem(`${template.file}: ${(error as Error).message}`);
  }
}

/** Calls `visit` with each node of a template, in the order of its text. */
export function walk(node: Node | undefined, visit: (node: Node) => void): void {
  if (!node) return;
  visit(node);
  const parts = node as Node & {
    body?: Node[];
    params?: Node[];
    program?: Node;
    inverse?: Node;
  };
  for (const part of [...(parts.body ?? []), ...(parts.params ?? [])]) walk(part, visit);
  walk(parts.program, visit);
  walk(parts.inverse, visit);
}

function sourceOf(path: hbs.AST.PathExpression): string {
  return path.original;
}

class Checker {
  constructor(
    readonly template: Template,
    readonly names: Names,
  ) {}

  refuse(node: Node, what: string): never {
    throw new Problem(`${this.template.file}:${node.loc.start.line}: ${what}`);
  }

  /** Refuses a path that leads nowhere. */
  checkPath(path: hbs.AST.PathExpression): void {
    const name = sourceOf(path);
    let value: unknown = this.names.data;
    let where = "";
    for (const part of path.parts) {
      const known = typeof value === "object" && value !== null ? Object.keys(value) : [];
      if (!known.includes(part)) {
        const helpers = where === "" ? [...Object.keys(this.names.helpers), ...blocks] : [];
        const all = [...known, ...helpers].sort();
        this.refuse(path, `{{${name}}}: no '${part}'${where}; there are ${listed(all)}`);
      }
      value = (value as Record<string, unknown>)[part];
      where = ` in ${path.parts.slice(0, path.parts.indexOf(part) + 1).join(".")}`;
    }
    if (typeof value !== "string" && typeof value !== "number" && typeof value !== "boolean")
      this.refuse(path, `{{${name}}}: a group of names; expected one of ${listed(Object.keys(value as object))}`);
  }

  checkCall(call: Call): void {
    const name = sourceOf(call.path);
    if (call.hash && call.hash.pairs.length > 0)
      this.refuse(call, `{{${name}}}: words with '='; expected texts in quotes only`);
    if (!(name in this.names.helpers) && !blocks.includes(name)) {
      const known = [...Object.keys(this.names.helpers), ...blocks].sort();
      this.refuse(call, `{{${name} ...}}: no such helper; there are ${listed(known)}`);
    }
  }

  checkParameter(node: Node): void {
    if (node.type === "SubExpression") this.checkCall(node as Call);
    else if (node.type === "PathExpression") this.checkPath(node as hbs.AST.PathExpression);
    else if (node.type !== "StringLiteral")
      this.refuse(node, `'${(node as hbs.AST.StringLiteral).original}'; expected a text in quotes or a name`);
    for (const parameter of (node as Partial<Call>).params ?? []) this.checkParameter(parameter);
  }

  check(node: Node): void {
    switch (node.type) {
      case "Program":
      case "ContentStatement":
      case "CommentStatement":
        return;
      case "MustacheStatement":
      case "BlockStatement": {
        const call = node as Call;
        const called = call.params.length > 0 || sourceOf(call.path) in this.names.helpers;
        if (called || node.type === "BlockStatement") this.checkCall(call);
        else this.checkPath(call.path);
        for (const parameter of call.params) this.checkParameter(parameter);
        return;
      }
      case "SubExpression":
      case "PathExpression":
      case "StringLiteral":
      case "NumberLiteral":
      case "BooleanLiteral":
        return;
      default:
        this.refuse(node, `a ${node.type}; expected text, {{names}} and {{#if}}`);
    }
  }
}

/** The text of a template with its names filled in. Throws Problem. */
export function fill(template: Template, names: Names): string {
  const program = parsed(template);
  const checker = new Checker(template, names);
  walk(program, (node) => checker.check(node));

  const handlebars = Handlebars.create();
  for (const [name, helper] of Object.entries(names.helpers)) {
    handlebars.registerHelper(name, (...words: unknown[]) => {
      const given = words.slice(0, -1).map(String);
      const { loc } = words.at(-1) as { loc?: hbs.AST.SourceLocation };
      try {
        if (given.length !== helper.length)
          throw new Problem(`${given.length} words; expected ${helper.length}`);
        return helper(...given);
      } catch (error) {
        if (!(error instanceof Problem)) throw error;
        const call = [name, ...given.map((word) => `"${word}"`)].join(" ");
        throw new Problem(`${template.file}${loc ? `:${loc.start.line}` : ""}: {{${call}}}: ${error.message}`);
      }
    });
  }
  return handlebars.compile(program, { strict: true, noEscape: true, explicitPartialContext: true })(names.data);
}
