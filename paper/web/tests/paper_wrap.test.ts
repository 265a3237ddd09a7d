// Lines are wrapped, and mean what they meant.
import assert from "node:assert/strict";
import { test } from "node:test";

import { wrapped } from "../wrap.ts";

test("paragraphs are wrapped, whatever their lines were", () => {
  assert.equal(wrapped("one two\nthree four five", 10), "one two\nthree four\nfive");
});

test("items hang, and each begins a line", () => {
  assert.equal(wrapped("- one two three\n  four\n- five\n12. six seven eight", 10), "- one two\n  three\n  four\n- five\n12. six\n    seven\n    eight");
});

test("quotations stay quotations", () => {
  assert.equal(wrapped("> one two three\n>\n> (II)", 10), "> one two\n> three\n>\n> (II)");
});

test("code, tables, headings and pictures stay as they are", () => {
  const text = "```\nlong  line of code\n```\n| a | long row |\n# A long heading\n![long picture](x.svg)";
  assert.equal(wrapped(text, 8), text);
});

test("no line begins with what would make it a list", () => {
  assert.equal(wrapped("aaaa n - 1 and 2. b", 6), "aaaa\nn - 1\nand 2.\nb");
});

test("wrapping twice is wrapping once", () => {
  const text = wrapped("a bb ccc dddd eeeee\n\n- a bb ccc dddd eeeee", 9);
  assert.equal(wrapped(text, 9), text);
});
