// Everything drawn contrasts with the background in both themes (WCAG 2.2, 1.4.11: 3 to 1).
import assert from "node:assert/strict";
import { test } from "node:test";

import { dark, light, rgb } from "../draw/colours.ts";

function luminance(colour: string): number {
  const [r, g, b] = rgb(colour).map((one) => one <= 0.04045 ? one / 12.92 : ((one + 0.055) / 1.055) ** 2.4);
  return 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
}

function contrast(a: string, b: string): number {
  const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y) as [number, number];
  return (high + 0.05) / (low + 0.05);
}

for (const [name, palette] of Object.entries({ light, dark })) {
  test(`marks and levels stand out in the ${name} theme`, () => {
    // The last mark is faded on purpose.
    for (const colour of [...palette.marks.slice(0, 5), palette.overlap, ...palette.levels]) {
      const ratio = contrast(colour, palette.background);
      assert.ok(ratio >= 3, `${colour} on ${palette.background}: ${ratio.toFixed(2)}`);
    }
    for (const colour of [palette.text, palette.muted]) assert.ok(contrast(colour, palette.background) >= 4.5);
  });
}
