// What is wrong with what the paper is made from: said to the user, without a stack.

/** Names the thing, the value found and the value expected. */
export class Problem extends Error {}

/** "a, b and c", to name what there is. */
export function listed(names: readonly string[]): string {
  if (names.length === 0) return "none";
  return names.length === 1 ? names[0]! : `${names.slice(0, -1).join(", ")} and ${names.at(-1)}`;
}
