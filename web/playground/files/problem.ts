// What is wrong with a file: the thing, what was found and what was expected.

export class FileProblem extends Error {}

export const mostFileBoxes = 500_000;

export function checkCount(count: number): void {
  if (count > mostFileBoxes)
    throw new FileProblem(`${count} boxes; the playground takes up to ${mostFileBoxes}. The program takes more.`);
}
