// Motion as a function of time, so that time can be scrubbed and a link shows the same boxes.

/** Position of a point that starts at `start` and bounces between two walls. */
export function bounce(start: number, speed: number, time: number, low: number, high: number):
    number {
  const width = high - low;
  if (!(width > 0)) return low;
  const way = (((start - low + speed * time) % (2 * width)) + 2 * width) % (2 * width);
  return low + (way <= width ? way : 2 * width - way);
}
