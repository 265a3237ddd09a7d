// The paper is made of its templates and results, and of nothing that is wrong in either.
import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";

import { documentOf, type Sources } from "../document.ts";
import { inRounds } from "../../../web/tests/fixture.ts";
import { Problem } from "../problem.ts";
import { run } from "../program.ts";
import { comparison, experiments, withoutRatios } from "./fixture.ts";

interface Given {
  experiments?: string;
  comparison?: string;
  supplements?: Sources["supplements"];
  quotes?: Sources["quotes"];
  quoting?: Sources["quoting"];
}

function paper(template: string, given: Given = {}): Map<string, string> {
  return documentOf({
    templates: [{ file: "07_testing.md", text: template }],
    supplements: given.supplements ?? {},
    quotes: given.quotes ?? {},
    quoting: given.quoting ?? {},
    experiments: { file: "e.json", text: given.experiments ?? JSON.stringify(experiments()) },
    comparison: { file: "c.json", text: given.comparison ?? JSON.stringify(comparison()) },
    pictures: ["../pictures/grid.svg"],
  });
}

/** The text without its first line, which says what it is made from. */
const textOf = (template: string, given: Given = {}) =>
  paper(template, given).get("paper.md")!.split("\n").slice(2).join("\n").trim();

/** A test's name, a template and what the message has to hold. */
function refuses(name: string, template: string, message: RegExp, given: Given = {}): void {
  test(name, () => {
    assert.throws(
      () => paper(template, given),
      (error) => {
        assert.ok(error instanceof Problem, String(error));
        assert.match(error.message, message);
        return true;
      },
    );
  });
}

test("figures are quoted with their unit", () => {
  assert.equal(textOf('{{figure "tests" "crossover"}}, {{figure "tests" "memory"}}'), "12 boxes, 2.76 MB");
  assert.equal(textOf('{{value "tests" "crossover"}}'), "12");
});

test("a verdict is quoted with its condition", () => {
  assert.equal(textOf('{{verdict "tests" "growth"}}'), "holds within bounds: there are more than 12 boxes");
});

test("a statement's row has what it says, what became of it, what was asked, and the evidence behind it", () => {
  const template = '{{judged "tests" "growth"}} {{with_interval "tests" "slope"}} |\n{{judged "tests" "square"}} - |';
  assert.equal(
    textOf(template),
    "| [1a](#tests) | tests grow \\| squarely | **holds within bounds**: there are more than 12 boxes | more than 1 | " +
      "1.50 (1.25 to 1.75) |\n| [1b](#tests) | n items make n\\*n | **not testable**: a tautology | - | - |",
  );
  assert.equal(textOf('{{with_interval "tests" "crossover"}}'), "12 boxes");
});

refuses("rows of some statements without the others", '{{judged "tests" "growth"}}', /no row is of the statement tests: square/);

test("our own claims are counted apart", () => {
  const own = experiments();
  own.experiments[0]!.section = "beyond";
  const given = { experiments: JSON.stringify(own) };
  assert.equal(textOf("{{experiments.claims}} {{experiments.own.statements}}", given), "0 2");
});

test("a supplement lists statements with what was asked and the figures that decided", () => {
  assert.match(
    textOf('{{statements "tests"}}').replaceAll("\n", " "),
    /more than 12 boxes\. Asked: more than 1\. Figures: +crossover 12 boxes; slope 1\.50 \(1\.25 to 1\.75\)\./,
  );
});

test("outcomes are counted by statement", () => {
  assert.equal(
    textOf("{{experiments.claims}} {{experiments.statements}} {{experiments.within_bounds}} {{experiments.not_testable}} {{experiments.refuted}}"),
    "1 2 1 1 0");
});

test("text follows the verdict", () => {
  const template =
    '{{#if (within_bounds "tests" "growth")}}sometimes{{else}}{{#if (refuted "tests" "growth")}}never{{/if}}{{/if}}';
  assert.equal(textOf(template), "sometimes");
  const other = experiments();
  other.experiments[0]!.statements[0]!.verdict = "refuted";
  assert.equal(textOf(template, { experiments: JSON.stringify(other) }), "never");
});

test("the machine is named", () => {
  assert.equal(textOf("{{machine.cpu}}, {{machine.cores}} cores, {{machine.memory}}"), "A CPU, 2 cores, 4 GB");
});

test("what would be Markdown in results is shown as it is", () => {
  assert.match(textOf('{{claim "tests"}}'), /n\\\*n tests/);
  assert.match(textOf('{{statements "tests"}}'), /\*n items make n\\\*n\*: \*\*not testable\*\*: a tautology\./);
});

test("tables have a row a line and nothing where nothing is known", () => {
  assert.equal(
    textOf('{{table "tests" "times"}}'),
    "*Times*\n\n| boxes | time (ms) |\n| ---: | ---: |\n| 10 | 1.23 |\n| 100 | - |\n| 1,000 | 123 |",
  );
});

test("charts are numbered, drawn and referred to before they stand there", () => {
  const made = paper('See {{see "tests"}}.\n\n{{charts "tests"}}');
  assert.match(made.get("paper.md")!, /See Figure 1\./);
  const [name] = [...made.keys()].filter((path) => path !== "paper.md");
  assert.equal(name, "figures/tests_times.svg");
  assert.match(made.get(name!)!, /^<svg[^>]*><title>Time over boxes\. Times<\/title>/);
});

test("pictures that the program drew are figures as well", () => {
  assert.match(textOf('{{picture "grid" "Cells" "a=grid"}}\n{{charts "tests"}}'), /\(\.\.\/pictures\/grid\.svg\)\n\n\*Figure 1\. Cells\. [^*]+`[^`]+#a=grid`\*\n.*\n\n\*Figure 2/);
});

refuses("an unknown picture", '{{picture "x" "X" ""}}', /no picture 'x\.svg'; there are grid\.svg/);

test("sources are numbered in their order, and cited by number", () => {
  assert.match(textOf('{{cite "b"}}{{cite "a"}}\n{{source "a"}}A\n{{source "b"}}B'), /^\[\[2\]\]\(#b\)\[\[1\]\]\(#a\)/);
});

test("supplements have figures of their own, and link to the paper's sources; it links to their sections", () => {
  const given = { supplements: { "claims.md": { file: "claims.md", text: '## {{heading "tests"}}\n\n{{cite "a"}}\n\n{{charts "tests"}}' } } };
  const made = paper('{{number "tests"}}{{cite "a"}}\n\n{{charts "tests"}}\n\n{{source "a"}}A', given);
  assert.match(made.get("paper.md")!, /\[1\]\(claims\.md#tests\)\[\[1\]\]\(#a\)[\s\S]*\*Figure 1\./);
  assert.match(made.get("claims.md")!, /<a id="tests"><\/a>[\s\S]*\[\[1\]\]\(paper\.md#a\)[\s\S]*\*Figure 1\./);
});

const page = (name: string) => `# Page\n\n<!-- quote: ${name} -->\nold\n<!-- end of quote -->\n\nrest\n`;
const lead = { lead: { file: "lead.md", text: "{{comparison.least_lead}}\n" } };

test("pages quote the same results, and keep the rest of their text", () => {
  const made = paper("a", { quotes: lead, quoting: { "../../README.md": page("lead") } });
  assert.equal(made.get("../../README.md"), page("lead").replace("old", "0.40\n"));
});

refuses("a quote that is not there", "a", /^p\.md: no quote 'leads'; there are lead$/, {
  quotes: lead, quoting: { "p.md": page("leads") + page("lead") },
});
refuses("a quote without an end", "a", /^p\.md: 2 quotes begin and 1 end/, {
  quotes: lead, quoting: { "p.md": `${page("lead")}<!-- quote: lead -->\n` },
});
refuses("a quote that no page has", "a", /no page quotes lead; expected each on a page/, { quotes: lead });

test("leads are given by group, of auto and of our best, with how many are lost and level", () => {
  const groups = textOf("{{groups}}").split("\n").slice(2).map((line) => line.replace(/ \|$/, "").split(" | ").slice(1));
  assert.deepEqual(groups, [
    ["1", "7.27 (6.86 to 7.71)", "7.3 (6.9 to 7.7)", "0 / 0", "8.00 (7.55 to 8.48)", "8.0 (7.5 to 8.5)", "0 / 0"],
    ["1", "0.500 (0.472 to 0.530)", "0.50 (0.47 to 0.53)", "1 / 0", "0.400 (0.377 to 0.424)", "0.40 (0.38 to 0.42)", "1 / 0"],
    ["2", "1.91 (1.83 to 1.99)", "0.50 (0.47 to 0.53)", "1 / 0", "1.79 (1.72 to 1.86)", "0.40 (0.38 to 0.42)", "1 / 0"],
  ]);
  assert.equal(textOf("{{comparison.groups.rest_3d.any}} {{comparison.groups.rest_2d.auto.mean}}"), "false 7.27");
  assert.match(textOf("{{comparison.auto_lead.lost_named}}"), /^uniform, 2D, 1,000 boxes, 10 % moving: 0\.50 \(0\.47 to 0\.53\)$/);
});

test("peers with assertions are left out of leads over the others, and marked", () => {
  assert.equal(textOf("{{comparison.released.cases}} {{comparison.released.mean}}"), "2 1.79");
  const given = { comparison: JSON.stringify(comparison()).replaceAll("bullet_dbvt", "box2d_tree") };
  assert.equal(textOf("{{comparison.released.cases}} {{comparison.released.mean}}", given), "1 8.00");
  assert.match(textOf('{{leads "moving"}}', given), /`box2d_tree` ‡ \|/);
});

test("listings that are faster than every peer are counted, and how results were checked", () => {
  assert.equal(textOf("{{comparison.listings_faster}}"), "1");
  const slow = withoutRatios();
  slow.measurements.find(({ kind }) => kind === "paper")!.median_ms = 16;
  assert.equal(textOf("{{comparison.listings_faster}}", { comparison: JSON.stringify(inRounds(slow)) }), "0");
  assert.equal(textOf("{{comparison.checked.by_definition}} {{comparison.checked.by_others}}"), "7 0");
  const by = "cross-checked by 15 structures of 6 libraries";
  const given = { comparison: JSON.stringify(comparison()).replaceAll('"the definition"', `"${by}"`) };
  assert.equal(textOf("{{comparison.checked.by_others}} {{comparison.checked.fewest_structures}} {{comparison.checked.fewest_libraries}}", given), "7 15 6");
});

test("unsteady measurements are counted and marked", () => {
  assert.equal(textOf("{{comparison.unsteady}}"), "0");
  const given = { comparison: JSON.stringify(comparison()).replaceAll('"verified":true', '"verified":true,"unsteady":true') };
  assert.equal(textOf("{{comparison.unsteady}}", given), "7");
  assert.match(textOf('{{leads "still"}}', given), /\| `grid` \| 1 † \|/);
});

test("a scene's parameters are those of its cases, and a library's version is the one that was measured", () => {
  assert.equal(textOf('{{parameters "uniform"}}'), "1,000 boxes, 1 seed; in motion 1,000 boxes, 1 seed, 5 frames, 10 % moving");
  assert.equal(textOf('{{version "bullet_dbvt"}}'), "1");
});

refuses("an unknown library", '{{version "x"}}', /no peer 'x'; there are boost_rtree and bullet_dbvt/);
refuses("parameters of an unknown scene", '{{parameters "x"}}', /no scene 'x'; there are uniform/);

test("ratios have their interval in brackets, and no columns for it", () => {
  const results = experiments();
  const [table] = results.experiments[0]!.tables;
  table!.columns.push({ name: "ratio", unit: "" }, { name: "ratio low", unit: "" }, { name: "ratio high", unit: "" });
  table!.rows = [[10, 1.5, 2, 1.5, 2.5], [20, 1.5, 1, 1, 1], [30, null, null, null, null]];
  assert.match(
    textOf('{{table "tests" "times"}}', { experiments: JSON.stringify(results) }),
    /\| ratio \|\n.*\n\| 10 \| 1\.50 \| 2 \(1\.50 to 2\.50\) \|\n\| 20 \| 1\.50 \| 1 \|\n\| 30 \| - \| - \|$/,
  );
});

test("a chart may have a caption of its own", () => {
  assert.match(textOf('{{captioned_chart "tests" "times" "Time over boxes" "As it is"}}'), /\*Figure 1\. As it is\*/);
});

test("the literature's algorithms are compared where there are any", () => {
  const template = "{{#if (any_literature)}}{{comparison.literature.algorithms}}, {{comparison.literature.mean}}{{else}}none{{/if}}";
  assert.equal(textOf(template), "none");
  assert.match(textOf("{{literature}}"), /No algorithm by the literature/);
  const given = { comparison: JSON.stringify(comparison()).replace(/"paper_grid"(.*?)"kind":"paper"/, '"karras_lbvh"$1"kind":"literature"') };
  assert.equal(textOf(template, given), "1, 4");
  assert.match(textOf("{{literature}}", given), /\| `karras_lbvh` \| 4 \| 4\.0 \(3\.8 to 4\.2\) \|/);
});

test("leads are those of our best other than auto, with intervals, and lost cases are named", () => {
  assert.equal(textOf("{{comparison.mean_lead_still}} {{comparison.least_lead}}"), "8.00 0.40");
  assert.equal(textOf("{{comparison.least_lead_interval}}"), "0.40 (0.38 to 0.42)");
  assert.match(textOf("{{lost}}"), /10 % moving: `bullet_dbvt` takes 1 ms.* 0\.40\s+\(0\.38 to 0\.42\)\./s);
  assert.match(textOf('{{leads "moving"}}'), /\| \*\*0\.40 \(0\.38 to 0\.42\)\*\* \|/);
  assert.equal(textOf("{{comparison.auto_worst}}"), "1.1");
  assert.equal(textOf("{{#if comparison.paired}}paired{{/if}}{{#if (any_level)}}, some level{{/if}}"), "paired");
});

test("the same sources give the same bytes", () => {
  const template = '{{charts "tests"}}\n{{comparison_chart "leads_still"}}\n{{comparison_chart "standings"}}';
  assert.deepEqual(paper(template), paper(template));
});

refuses("an unknown experiment", 'a\n{{claim "test"}}', /^07_testing\.md:2: \{\{claim "test"\}\}: .*there are tests$/);
refuses("an unknown statement", '{{verdict "tests" "x"}}', /no statement .*'x'; there are growth and square$/);
refuses("an unknown figure", '{{figure "tests" "x"}}', /no figure .* 'x'; there are crossover, slope and memory$/);
refuses("an unknown chart", '{{chart "tests" "times" "Tim"}}', /no chart .*'Tim'; there are Time over boxes$/);
refuses("an unknown table", '{{table "tests" "x"}}', /no table .* 'x'; there are times$/);
refuses("an unknown name", "a\n\n{{machine.cpus}}", /^07_testing\.md:3: \{\{machine\.cpus\}\}: no 'cpus' in machine; .*cpu/);
refuses("an unknown helper", '{{figures "tests"}}', /no such helper; there are .*figure/);
refuses("a group for a name", "{{machine}}", /a group of names; expected one of cpu/);
refuses("an unknown name in a condition", '{{#if (confirmed "x" "y")}}a{{/if}}', /no experiment 'x'/);
refuses("a word too many", '{{claim "tests" "now"}}', /2 words; expected 1/);
refuses("a number in place of a name", "{{claim 1}}", /expected a text in quotes/);
refuses("loops", '{{#each machine}}a{{/each}}', /no such helper/);
refuses("what is no template", "{{#if}}", /07_testing\.md: Parse error/);
refuses("an unknown source", '{{cite "b"}} {{source "a"}}', /no source 'b'; there are a$/);
refuses("a source that nothing cites", '{{source "a"}}', /nothing cites the source a/);
refuses("more figures than can be printed", '{{charts "tests"}}', /^paper\.md: 26 figures; expected at most 25/, {
  experiments: JSON.stringify({
    ...experiments(),
    experiments: experiments().experiments.map((one) => ({
      ...one,
      tables: one.tables.map((table) => ({
        ...table, charts: Array.from({ length: 26 }, (_, i) => ({ ...table.charts[0]!, title: `Chart ${i}` })),
      })),
    })),
  }),
});
refuses("a chart that stands there twice", '{{charts "tests"}}{{charts "tests"}}', /stands in the paper already/);

const changed = (change: (results: ReturnType<typeof experiments>) => void) => {
  const results = experiments();
  change(results);
  return { experiments: JSON.stringify(results) };
};

refuses("an empty file", "a", /^e\.json: .*expected JSON of the schema/, { experiments: "" });
refuses("results cut off", "a", /^e\.json: .*expected JSON/, { experiments: '{"schema": "broadside.exp' });
refuses("NaN in results", "a", /^e\.json: .*expected JSON/, {
  experiments: JSON.stringify(experiments()).replace('"value":12', '"value":NaN'),
});
refuses("infinity in results", "a", /figures: crossover: value: Infinity; expected a finite number/, {
  experiments: JSON.stringify(experiments()).replace('"value":12', '"value":1e999'),
});
refuses("null for a figure", "a", /figures: crossover: value: null; expected a finite number/, {
  experiments: JSON.stringify(experiments()).replace('"value":12', '"value":null'),
});
refuses("no experiments", "a", /experiments: \[\]; expected at least one experiment/, changed((results) => {
  results.experiments = [];
}));
refuses("a verdict that is none", "a", /verdict: "holds"; expected 'confirmed' or 'holds within bounds' or/, {
  experiments: JSON.stringify(experiments()).replace('"verdict":"not testable"', '"verdict":"holds"'),
});
refuses("evidence that is no figure", "a", /figures: slopes: nothing; expected an object/, {
  experiments: JSON.stringify(experiments()).replace('"crossover","slope"', '"crossover","slopes"'),
});
refuses("a row that is too short", "a", /rows\[0\]: \[10\]; expected 2 cells/, changed((results) => {
  results.experiments[0]!.tables[0]!.rows[0]!.pop();
}));
refuses("a run that was stopped", "a", /stopped: true; expected false/, changed((results) => {
  results.stopped = true;
}));
refuses("another schema version", "a", /schema: "broadside\.experiments\/1"; expected 'broadside\.experiments\/2'/, {
  experiments: JSON.stringify(experiments()).replace("experiments/2", "experiments/1"),
});
refuses("a comparison of another schema", "a", /^c\.json: schema: .*expected 'broadside\.results\/2'/, {
  comparison: JSON.stringify(experiments()),
});
refuses("a comparison with a wrong result", "a", /verified: false; expected true/, {
  comparison: JSON.stringify(comparison()).replace('"verified":true', '"verified":false'),
});
refuses("a ratio that is none", "a", /ratio_to_fastest: median: "2"; expected a finite number/, {
  comparison: JSON.stringify(comparison()).replace(/("ratio_to_fastest":\{"of":"[^"]*","median":)[\d.]+/, '$1"2"'),
});
refuses("a comparison without peers", "a", /no case of boxes that rest with times of ours and of a peer/, {
  comparison: JSON.stringify(comparison()).replaceAll('"peer"', '"paper"'),
});

/** A folder with sources, and what the program prints. */
function tryProgram(check: (folder: string, make: (...words: string[]) => number, printed: () => string) => void): void {
  const folder = mkdtempSync(join(tmpdir(), "paper-"));
  try {
    mkdirSync(join(folder, "templates"));
    writeFileSync(join(folder, "templates", "01.md"), '{{claim "tests"}}\n\n{{charts "tests"}}\n');
    writeFileSync(join(folder, "e.json"), JSON.stringify(experiments()));
    writeFileSync(join(folder, "c.json"), JSON.stringify(comparison()));
    let printed = "";
    const print = (text: string) => {
      printed = text;
    };
    const paths = ["e.json", "c.json", "templates", "."].map((path) => join(folder, path));
    check(folder, (...words) => run([...words, ...paths], { out: print, error: print }), () => printed);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

test("the program writes the paper, drops figures that are gone, and then finds it up to date", () => {
  tryProgram((folder, make, printed) => {
    assert.equal(make("--check"), 1);
    assert.match(printed(), /paper\.md/);
    mkdirSync(join(folder, "figures"));
    writeFileSync(join(folder, "figures", "old.svg"), "old");
    assert.equal(make(), 0);
    assert.deepEqual(readdirSync(join(folder, "figures")), ["tests_times.svg"]);
    assert.equal(make("--check"), 0);
    writeFileSync(join(folder, "figures", "tests_times.svg"), "other");
    assert.equal(make("--check"), 1);
    assert.match(printed(), /tests_times\.svg/);
  });
});

for (const [what, file, text] of [
  ["results that cannot be read", "e.json", "{"],
  ["a template with an unknown experiment", "templates/01.md", '{{claim "x"}}'],
] as const) {
  test(`${what} leave the old paper as it was`, () => {
    tryProgram((folder, make, printed) => {
      assert.equal(make(), 0);
      const before = readFileSync(join(folder, "paper.md"), "utf8");
      writeFileSync(join(folder, file), text);
      assert.equal(make(), 2);
      assert.match(printed(), /^make paper: /);
      assert.equal(readFileSync(join(folder, "paper.md"), "utf8"), before);
      assert.deepEqual(readdirSync(join(folder, "figures")), ["tests_times.svg"]);
    });
  });
}

test("files that are missing are named", () => {
  tryProgram((folder, make, printed) => {
    rmSync(join(folder, "c.json"));
    assert.equal(make(), 2);
    assert.match(printed(), /c\.json: .*expected results of broadside compare/);
  });
});
