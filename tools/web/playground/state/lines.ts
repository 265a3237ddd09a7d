// Code to copy: the search of a panel, in a program of the visitor.
import { nameOf } from "./spec.ts";

export type Language = "C++" | "Python" | "JavaScript";

export const languages: readonly Language[] = ["C++", "Python", "JavaScript"];

const quoted = (text: string): string => JSON.stringify(text);

/**
 * The program's code. The draft's listings are in no package, so the library's algorithm of the
 * same kind is used.
 */
export function linesFor(language: Language, spec: string, dimension: 2 | 3, follow: boolean): string {
  const own = nameOf(spec).startsWith("paper_") ? nameOf(spec).replace("paper_", "") : spec;
  const plain = own === "auto";
  switch (language) {
    case "C++":
      return follow
        ? [
          "#include <broadside/broadside.hpp>", "",
          `broadside::World${dimension} world(${plain ? "" : quoted(own)});`,
          "const broadside::Handle box = world.add(/* ... */);",
          "const broadside::Events events = world.update();  // events.begun, events.ended",
        ].join("\n").replace(" world();", " world;")
        : [
          "#include <broadside/broadside.hpp>", "",
          `std::vector<broadside::Box${dimension}> boxes = /* ... */;`,
          `const auto pairs = broadside::find_pairs(boxes${plain ? "" : `, {.algorithm = ${quoted(own)}}`});`,
        ].join("\n");
    case "Python": {
      const named = plain ? "" : `algorithm=${quoted(own)}`;
      return follow
        ? [
          "import broadside", "",
          `world = broadside.World(${[String(dimension), named].filter(Boolean).join(", ")})`,
          "handles = world.add(boxes)", "begun, ended = world.update()",
        ].join("\n")
        : ["import broadside", "", `pairs = broadside.pairs(${["boxes", named].filter(Boolean).join(", ")})`].join("\n");
    }
    case "JavaScript": {
      const options = `{ dimension: ${dimension}${plain ? "" : `, algorithm: ${quoted(own)}`} }`;
      return [
        'import { load } from "broadside";', "", "const broadside = await load();",
        follow ? `const world = broadside.world(${options});` : `const pairs = broadside.pairs(boxes, ${options});`,
        ...(follow ? ["world.add(boxes);", "const { begun, ended } = world.update();"] : []),
      ].join("\n");
    }
  }
}
