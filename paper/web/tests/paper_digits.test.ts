// No number is typed into the chapters that tell of measurements.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { typedDigits } from "../typed_digits.ts";
import { project } from "./fixture.ts";

const chapters = [
  "00_abstract", "07a_method", "07b_claims", "07c_comparison", "07d_ablation", "08_conclusion", "09_threats",
  "10_reproduce",
  "supplements/claims", "supplements/comparison", "supplements/quoted", "quotes/caption", "quotes/figures", "quotes/leads",
];

const fileOf = (chapter: string) => `paper/templates/${chapter}.md`;
const textOf = (chapter: string) => readFileSync(join(project, fileOf(chapter)), "utf8");

for (const chapter of chapters) {
  test(`no digit is typed into ${fileOf(chapter)}`, () => {
    const file = fileOf(chapter);
    const found = typedDigits({ file, text: textOf(chapter) });
    assert.deepEqual(
      found.map(({ line, text }) => `${file}:${line}: ${text}`),
      [],
      "a number must come from the results: write a placeholder",
    );
  });

  test(`a digit put into ${fileOf(chapter)} is found`, () => {
    const text = textOf(chapter);
    const lines = text.split("\n").length;
    assert.deepEqual(typedDigits({ file: chapter, text: `${text}It took 7 ms.\n` }), [
      { line: lines, text: "It took 7 ms." },
    ]);
  });
}

const linesOf = (text: string) => typedDigits({ file: "chapter", text }).map(({ line }) => line);

test("digits in the names that a placeholder has are not typed numbers", () => {
  assert.deepEqual(linesOf('{{figure "overtaking" "tests_at_10000"}} and {{machine.cores}}'), []);
});

test("a number that stands for itself in a placeholder is one", () => {
  assert.deepEqual(linesOf("one\n{{shown 42}}"), [2]);
});

test("digits in blocks, in tables, in powers and in entities are found", () => {
  assert.deepEqual(linesOf('{{#if (holds "x")}}\nup to 3 %\n{{else}}\n| 4 |\n{{/if}}\nn² &#52;'), [2, 4, 6]);
});

test("comments are not printed, and may hold digits", () => {
  assert.deepEqual(linesOf("{{! figure 3 }}"), []);
});
