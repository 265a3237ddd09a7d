// Algorithms 2 to 4 of the draft, mended, step by step. Cell sizes are chosen by the rules of
// paper/listings/grid_listing.cpp.
import type { GridState, StepOptions, Steps, World } from "../engine/types.ts";
import { isPresent, presentIds, reportPoint, worldAround, type Box } from "./boxes.ts";
import { Listing } from "./listing.ts";
import { Recorder } from "./recorder.ts";
import { Versions } from "./versions.ts";

type Line = "size" | "double" | "allocate" | "insert" | "add" | "cell" | "search";

const listing = new Listing<Line | "test" | "report">([
  ["", "function Init(world, size)"],
  ["size", "  xGrids <- Ceil(width / size), yGrids <- Ceil(height / size)"],
  ["double", "  while that is too much for memory do size <- 2 size"],
  ["allocate", "  G <- xGrids by yGrids empty cells"],
  ["", "end function"],
  ["", ""],
  ["", "function Spanning Add Element(E)"],
  ["insert", "  for i = 0 to E.length - 1 do"],
  ["", "    for row = Row(E[i].MINY) to Row(E[i].MAXY) do"],
  ["", "      for col = Col(E[i].MINX) to Col(E[i].MAXX) do"],
  ["add", "        G[col][row].Add(E[i])"],
  ["", "      end for"],
  ["", "    end for"],
  ["", "  end for"],
  ["", "end function"],
  ["", ""],
  ["", "function SPI(G)"],
  ["", "  for i = 0 to xGrids - 1 do"],
  ["", "    for j = 0 to yGrids - 1 do"],
  ["cell", "      Brute Force(G[i][j])"],
  ["", "    end for"],
  ["", "  end for"],
  ["", "end function"],
  ["", ""],
  ["search", "function Brute Force(E)"],
  ["", "  for i = 0 to E.length - 1 do"],
  ["", "    for j = i + 1 to E.length - 1 do"],
  ["test", "      if Test Collide(E[i], E[j]) then"],
  ["report", "        if this cell holds their greater MINX and MINY then report E[i] and E[j]"],
  ["", "      end if"],
  ["", "    end for"],
  ["", "  end for"],
  ["", "end function"],
]);

/** The cells over a world. */
class Layout {
  readonly world: World;
  readonly size: number;
  readonly columns: number;
  readonly rows: number;

  constructor(world: World, size: number) {
    this.world = world;
    this.size = size;
    this.columns = Math.max(1, Math.ceil(world.width / size));
    this.rows = Math.max(1, Math.ceil(world.height / size));
  }

  column(x: number): number {
    return this.#cell(x, this.world.left, this.columns);
  }

  row(y: number): number {
    return this.#cell(y, this.world.top, this.rows);
  }

  span(box: Box): [number, number, number, number] {
    return [this.column(box.minX), this.column(box.maxX), this.row(box.minY), this.row(box.maxY)];
  }

  /** Positions outside the world are in the cell at its border. */
  #cell(x: number, begin: number, count: number): number {
    return Math.min(Math.max(Math.floor((x - begin) / this.size), 0), count - 1);
  }
}

/**
 * Twice the mean finite extent; if the boxes have no extent, the size that gives each box a cell of
 * its own.
 */
function chosenSize(boxes: readonly Box[], world: World): number {
  let sum = 0;
  let count = 0;
  for (const box of boxes) {
    for (const extent of [box.maxX - box.minX, box.maxY - box.minY]) {
      if (!Number.isFinite(extent)) continue;
      sum += extent;
      count += 1;
    }
  }
  if (sum > 0) return 2 * sum / count;
  return Math.max(world.width, world.height) / Math.sqrt(Math.max(1, boxes.length));
}

/** Whether this grid would exceed the limit on cells or references. */
function isTooLarge(boxes: readonly Box[], layout: Layout, isChosen: boolean): boolean {
  const count = boxes.length;
  const maxCells = isChosen ? Math.min(4 * count, 2 ** 22) : Math.min(Math.max(16 * count, 2 ** 16), 2 ** 22);
  if (layout.columns * layout.rows > Math.max(1, maxCells)) return true;
  let references = 0;
  for (const box of boxes) {
    const [left, right, top, bottom] = layout.span(box);
    references += (right - left + 1) * (bottom - top + 1);
  }
  return references > (isChosen ? 16 * count : Math.max(64 * count, 2 ** 18));
}

export function gridSteps(boxes: readonly Box[], { cell: given }: StepOptions): Steps {
  if (given !== undefined && !(given > 0 && given < Infinity))
    throw new Error(`cell is ${given}; expected a number above 0`);
  const recorder = new Recorder<Line, GridState>(listing);
  const present = boxes.filter(isPresent);
  if (present.length === 0) return recorder.finish();
  const isChosen = given === undefined;
  const world = worldAround(present);
  let layout = new Layout(world, given ?? chosenSize(present, world));
  const cells = new Versions<readonly number[]>();
  const stateOf = (more: Partial<GridState> = {}): GridState => {
    const version = cells.latest;
    const { size, columns, rows } = layout;
    return { kind: "grid", world, size, columns, rows, current: -1, ...more, get cells() { return cells.at(version); } };
  };

  recorder.step("size", `Cells of ${shortNumber(layout.size)} make ${layout.columns} columns and ${layout.rows} rows`,
                [], stateOf());
  while (isTooLarge(present, layout, isChosen)) {
    layout = new Layout(world, 2 * layout.size);
    recorder.step("double", `That is too much: ${shortNumber(layout.size)} makes ${layout.columns} columns and ` +
                  `${layout.rows} rows`, [], stateOf());
  }
  for (let cell = 0; cell < layout.columns * layout.rows; ++cell) cells.set(cell, []);
  recorder.step("allocate", `${layout.columns} by ${layout.rows} empty cells`, [], stateOf());

  for (const id of presentIds(boxes)) {
    const span = layout.span(boxes[id]!);
    const [left, right, top, bottom] = span;
    const count = (right - left + 1) * (bottom - top + 1);
    recorder.step("insert", `Box ${id} touches ${count} ${count === 1 ? "cell" : "cells"}`, [id],
                  stateOf({ span }));
    for (let row = top; row <= bottom; ++row) {
      for (let column = left; column <= right; ++column) {
        const current = column * layout.rows + row;
        cells.set(current, [...cells.items[current]!, id]);
        recorder.step("add", `Box ${id} is added to column ${column}, row ${row}`, [id],
                      stateOf({ current, span }));
      }
    }
  }

  for (const [current, e] of cells.items.entries()) {
    const column = Math.floor(current / layout.rows);
    const row = current % layout.rows;
    if (e.length === 0) continue;
    const state = stateOf({ current });
    recorder.step("cell", `Column ${column}, row ${row} has ${e.length} ${e.length === 1 ? "box" : "boxes"}`, [...e],
                  state);
    for (let i = 0; i < e.length; ++i) {
      for (let j = i + 1; j < e.length; ++j) {
        const [a, b] = [e[i]!, e[j]!];
        const point = reportPoint(boxes[a]!, boxes[b]!);
        const [ownColumn, ownRow] = [layout.column(point[0]), layout.row(point[1])];
        const refusal = (): string | undefined => ownColumn === column && ownRow === row ? undefined :
          `Boxes ${a} and ${b} overlap, but column ${ownColumn}, row ${ownRow} reports their pair`;
        recorder.test(boxes, a, b, state, refusal, stateOf({ current, point }));
      }
    }
  }
  return recorder.finish();
}

export function shortNumber(number: number): string {
  return String(Number(number.toPrecision(3)));
}
