// Random numbers determined by a seed and an index, so that box 7 is the same whatever the number
// of boxes.

/** A number in [0, 1) for a seed, a box and a purpose. */
export function randomAt(seed: number, box: number, purpose: number): number {
  let bits = Math.imul(seed ^ 0x9e3779b9, 0x85ebca6b) ^ Math.imul(box + 1, 0xc2b2ae35);
  bits ^= Math.imul(purpose + 1, 0x27d4eb2f);
  bits = Math.imul(bits ^ (bits >>> 16), 0x7feb352d);
  bits = Math.imul(bits ^ (bits >>> 15), 0x846ca68b);
  return ((bits ^ (bits >>> 16)) >>> 0) / 2 ** 32;
}

/** A number from the standard normal distribution (Box and Muller). */
export function normalAt(seed: number, box: number, purpose: number): number {
  const radius = Math.sqrt(-2 * Math.log(1 - randomAt(seed, box, purpose)));
  return radius * Math.cos(2 * Math.PI * randomAt(seed, box, purpose + 1));
}
