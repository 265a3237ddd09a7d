// Pieces of Markdown.

/** Text as Markdown that shows it as it is, in a paragraph or a cell of a table. */
export function plain(text: string): string {
  return text.replace(/[\\*<|`[\]]/g, (sign) => (sign === "<" ? "&lt;" : `\\${sign}`));
}

/** A table; columns whose name begins with a space are aligned to the right. */
export function tableText(columns: readonly string[], rows: readonly (readonly string[])[]): string {
  const line = (cells: readonly string[]) => `| ${cells.join(" | ")} |`;
  return [
    line(columns.map((name) => name.trim())),
    line(columns.map((name) => (name.startsWith(" ") ? "---:" : "---"))),
    ...rows.map(line),
  ].join("\n");
}
