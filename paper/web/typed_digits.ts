// Finds digits that were typed into a template: every measured number must come from the results.
import { parsed, walk, type Template } from "./fill.ts";

export interface TypedDigit {
  line: number;
  text: string;
}

/**
 * The lines of a template in which a digit stands outside a placeholder, or a number stands in one for itself.
 * Digits in the names that a placeholder has are none.
 */
export function typedDigits(template: Template): TypedDigit[] {
  const found: TypedDigit[] = [];
  walk(parsed(template), (node) => {
    if (node.type === "NumberLiteral") {
      found.push({ line: node.loc.start.line, text: String((node as hbs.AST.NumberLiteral).original) });
    } else if (node.type === "ContentStatement") {
      const lines = String((node as hbs.AST.ContentStatement).original).split("\n");
      lines.forEach((text, i) => {
        if (/\p{N}/u.test(text)) found.push({ line: node.loc.start.line + i, text: text.trim() });
      });
    }
  });
  return found;
}
