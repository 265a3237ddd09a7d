// The advice in messages of the program's readers.

/** A message without the options of the program, and the columns as which it says that a table can be read. */
export function withoutOptions(message: string): { text: string; ways: string[] } {
  const choice = /; as (.+?) ((?:all [\d,]+ rows are|the one row is) valid): say (?:which by --columns|--columns=([^\s;]+))/.exec(message);
  if (choice !== null) {
    const fault = message.slice(0, message.indexOf("; expected"));
    return { text: `${fault}. But ${choice[2]} as this:`, ways: choice[3] === undefined ? choice[1]!.split(" or ") : [choice[3]] };
  }
  const guess = /; --columns (\S+) if (?:they are|it is) a corner and the size/.exec(message);
  const text = message
    .replace(guess?.[0] ?? "", "")
    .replace("; --columns can name them", "; or give them such names in the first line")
    .replace(", or names with --columns", ", or names in the first line")
    .replace(/, with --columns=\S+ if they are COCO's/, "")
    .replace(/; or --longitude of pairs, if the box is across the date line/, "");
  return { text, ways: guess === null ? [] : [guess[1]!] };
}
