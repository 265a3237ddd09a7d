// Paragraphs of Markdown in lines of a length that people read.

/** What begins a line of its own: headings, tables, pictures, notices, the rule under a quotation's text. */
const whole = /^(#|\||!\[|<!--|>\s*$)/;

/** What a line must not begin with by chance: there it would be a list, a heading or a quotation. */
const marker = /^(?:[-+*]|\d+[.)]|#+|=+)$|^[>|]/;

/** The prefix of a paragraph's first line, and of the lines that follow. */
function prefixes(line: string): [string, string] {
  if (line.startsWith("> ")) return ["> ", "> "];
  const item = /^(\s*(?:[-*]|\d+\.) +)/.exec(line)?.[1] ?? "";
  return [item, " ".repeat(item.length)];
}

function wrapParagraph(lines: readonly string[], width: number): string[] {
  const [first, other] = prefixes(lines[0]!);
  const words = lines.flatMap((line, i) => {
    const quoted = first === "> " && line.startsWith("> ");
    return line.slice(i === 0 || quoted ? first.length : 0).split(" ").filter((word) => word !== "");
  });
  const units: string[] = [];
  for (const word of words) {
    if (units.length > 0 && marker.test(word)) units[units.length - 1] += ` ${word}`;
    else units.push(word);
  }
  const wrapped: string[] = [];
  let line = first;
  let empty = true;
  for (const word of units) {
    if (!empty && line.length + 1 + word.length > width) {
      wrapped.push(line);
      line = other;
      empty = true;
    }
    line += empty ? word : ` ${word}`;
    empty = false;
  }
  return [...wrapped, line];
}

/** The same text, its paragraphs in lines of at most `width` characters where words allow. */
export function wrapped(markdown: string, width = 120): string {
  const result: string[] = [];
  let paragraph: string[] = [];
  let code = false;
  const endParagraph = () => {
    if (paragraph.length > 0) result.push(...wrapParagraph(paragraph, width));
    paragraph = [];
  };
  for (const line of markdown.split("\n")) {
    if (line.startsWith("```")) {
      endParagraph();
      code = !code;
      result.push(line);
    } else if (code || line.trim() === "" || whole.test(line)) {
      endParagraph();
      result.push(line);
    } else {
      if (/^\s*(?:[-*]|\d+\.) /.test(line)) endParagraph();
      paragraph.push(line);
    }
  }
  endParagraph();
  return result.join("\n");
}
