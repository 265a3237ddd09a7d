// The advice in messages of the program's readers.

/** A message without the options of the program, and the columns as which it says that a table can be read. */
export function withoutOptions(message: string): { text: string; ways: string[] } {
  const choice = /; as (.+?) ((?:all [\d,]+ rows are|the one row is) valid): say (which by --columns|--columns=(\S+))/.exec(message);
  const guess = /; --columns (\S+) if (?:they are|it is) a corner and the size/.exec(message);
  const ways = choice !== null ? (choice[4] === undefined ? choice[1]!.split(" or ") : [choice[4]])
    : guess !== null ? [guess[1]!] : [];
  const text = message
    .replace(choice?.[0] ?? guess?.[0] ?? "", choice === null ? "" : `; ${choice[2]} as this:`)
    .replace("; --columns can name them", "; or give them such names in the first line")
    .replace(", or names with --columns", ", or names in the first line")
    .replace(/, with --columns=\S+ if they are COCO's/, "")
    .replace(/; or --longitude of pairs, if the box is across the date line/, "");
  return { text, ways };
}
