// The definition of a pair, for tests.

/** All overlapping pairs, as sorted "a b" with a < b. */
export function pairsByDefinition(boxes: ArrayLike<number>, dimension: number): string[] {
  const stride = 2 * dimension;
  const found: string[] = [];
  for (let a = 0; a < boxes.length / stride; ++a) {
    for (let b = a + 1; b < boxes.length / stride; ++b) {
      let overlap = true;
      for (let axis = 0; axis < dimension; ++axis) {
        overlap &&= boxes[stride * a + axis]! <= boxes[stride * b + dimension + axis]! &&
          boxes[stride * b + axis]! <= boxes[stride * a + dimension + axis]!;
      }
      if (overlap) found.push(`${a} ${b}`);
    }
  }
  return found.sort();
}

export function asText(pairs: ArrayLike<number>): string[] {
  return Array.from({ length: pairs.length / 2 }, (_, at) => {
    const [a, b] = [pairs[2 * at]!, pairs[2 * at + 1]!];
    return `${Math.min(a, b)} ${Math.max(a, b)}`;
  }).sort();
}
