// No number is typed into the chapters that tell of measurements.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { typed_digits } from "../paper/typed_digits.ts";
import { project } from "./paper_fixture.ts";

const chapters = ["00_abstract", "07_testing", "08_conclusion", "09_threats", "10_reproduce"];

const file_of = (chapter: string) => `paper/templates/${chapter}.md`;
const text_of = (chapter: string) => readFileSync(join(project, file_of(chapter)), "utf8");

for (const chapter of chapters) {
  test(`no digit is typed into ${file_of(chapter)}`, () => {
    const file = file_of(chapter);
    const found = typed_digits({ file, text: text_of(chapter) });
    assert.deepEqual(
      found.map(({ line, text }) => `${file}:${line}: ${text}`),
      [],
      "a number must come from the results: write a placeholder",
    );
  });

  test(`a digit put into ${file_of(chapter)} is found`, () => {
    const text = text_of(chapter);
    const lines = text.split("\n").length;
    assert.deepEqual(typed_digits({ file: chapter, text: `${text}It took 7 ms.\n` }), [
      { line: lines, text: "It took 7 ms." },
    ]);
  });
}

const lines_of = (text: string) => typed_digits({ file: "chapter", text }).map(({ line }) => line);

test("digits in the names that a placeholder has are not typed numbers", () => {
  assert.deepEqual(lines_of('{{figure "overtaking" "tests_at_10000"}} and {{machine.cores}}'), []);
});

test("a number that stands for itself in a placeholder is one", () => {
  assert.deepEqual(lines_of("one\n{{shown 42}}"), [2]);
});

test("digits in blocks, in tables, in powers and in entities are found", () => {
  assert.deepEqual(lines_of('{{#if (holds "x")}}\nup to 3 %\n{{else}}\n| 4 |\n{{/if}}\nn² &#52;'), [2, 4, 6]);
});

test("comments are not printed, and may hold digits", () => {
  assert.deepEqual(lines_of("{{! figure 3 }}"), []);
});
