// Tables that sort and filter: a real <table> with buttons in its head and aria-sort; the number of
// remaining rows is announced to screen readers.
import { grouped } from "../charts/numbers.ts";
import { el, newId, picker, say } from "./dom.ts";

export interface DataColumn<Row> {
  title: string;
  /** Sort key; null is last in either order. */
  value: (row: Row) => number | string | null;
  /** Default: the value as it is. */
  text?: (row: Row) => string;
}

export interface DataFilter<Row> {
  title: string;
  value: (row: Row) => string;
}

export interface DataTableSpec<Row> {
  caption: string;
  columns: readonly DataColumn<Row>[];
  rows: readonly Row[];
  /** Each is a list of choices; lists that would offer only one choice are left out. */
  filters?: readonly DataFilter<Row>[];
  /** Text of any length, below its row and as wide as the visible table; null for none. */
  note?: (row: Row) => string | null;
  /** Adds a search field, which matches the texts of rows. */
  search?: boolean;
}

const pageRows = 100;

function textOf<Row>(column: DataColumn<Row>, row: Row): string {
  return column.text?.(row) ?? String(column.value(row) ?? "–");
}

function compare(a: number | string | null, b: number | string | null, direction: number): number {
  if (a === null || b === null) return a === b ? 0 : a === null ? 1 : -1;
  if (typeof a === "number" && typeof b === "number") return direction * (a - b);
  return direction * String(a).localeCompare(String(b), "en", { numeric: true });
}

export function dataTable<Row>(spec: DataTableSpec<Row>): HTMLElement {
  const chosen = new Map<DataFilter<Row>, string>();
  let searched = "";
  let sorted = -1;
  let direction = 1;
  let maxRows = pageRows;

  const numeric = spec.columns.map((column) => spec.rows.every((row) => typeof column.value(row) !== "string"));
  const classOf = (i: number): string => (numeric[i] === true ? "number" : "");
  const body = el("tbody");
  const count = el("p", { class: "note" });
  const more = el("button", { type: "button", class: "more", onclick: () => {
    maxRows = Infinity;
    show();
  } });
  const heads = spec.columns.map((column, i) => el("th", { scope: "col", class: classOf(i) },
    el("button", { type: "button", onclick: () => sortBy(i) }, column.title),
    // Chromium repeats a head on each printed page, but without the buttons in it.
    el("span", { class: "printed", "aria-hidden": "true" }, column.title)));

  function sortBy(i: number): void {
    direction = sorted === i ? -direction : 1;
    sorted = i;
    heads.forEach((head, at) => {
      if (at === i) head.setAttribute("aria-sort", direction > 0 ? "ascending" : "descending");
      else head.removeAttribute("aria-sort");
    });
    show();
    say(`sorted by ${spec.columns[i]?.title ?? ""}, ${direction > 0 ? "ascending" : "descending"}`);
  }

  function rowsLeft(): Row[] {
    const words = searched.toLowerCase().split(/\s+/).filter((word) => word !== "");
    const left = spec.rows.filter((row) =>
      [...chosen].every(([filter, value]) => filter.value(row) === value) &&
      (words.length === 0 || (() => {
        const text = [...spec.columns.map((column) => textOf(column, row)), spec.note?.(row) ?? ""].join(" ").toLowerCase();
        return words.every((word) => text.includes(word));
      })()));
    const column = spec.columns[sorted];
    return column === undefined ? left : left.sort((a, b) => compare(column.value(a), column.value(b), direction));
  }

  function show(): void {
    const left = rowsLeft();
    const shown = left.slice(0, maxRows);
    body.replaceChildren(...shown.flatMap((row) => {
      const note = spec.note?.(row) ?? null;
      const cells = spec.columns.map((column, i) => el("td", { class: classOf(i) }, textOf(column, row)));
      if (note === null) return [el("tr", {}, ...cells)];
      return [el("tr", { class: "noted" }, ...cells),
        el("tr", { class: "remark" }, el("td", { colspan: spec.columns.length }, el("p", {}, note)))];
    }));
    const rows = left.length === 1 ? "row" : "rows";
    count.textContent = left.length === spec.rows.length
      ? `${grouped(left.length)} ${rows}` : `${grouped(left.length)} of ${grouped(spec.rows.length)} rows`;
    if (shown.length < left.length) count.textContent += `, the first ${grouped(shown.length)} of them shown`;
    more.hidden = shown.length === left.length;
    more.textContent = more.hidden ? "Show all rows" : `Show all ${grouped(left.length)} rows`;
  }

  function filtered(): void {
    maxRows = pageRows;
    show();
    say(count.textContent ?? "");
  }

  const controls = (spec.filters ?? []).flatMap((filter) => {
    const values = [...new Set(spec.rows.map(filter.value))];
    if (values.length < 2) return [];
    return [picker(filter.title, [["", "all"], ...values.map((value) => [value, value] as const)], (value) => {
      if (value === "") chosen.delete(filter);
      else chosen.set(filter, value);
      filtered();
    })];
  });
  if (spec.search === true) {
    const input = el("input", { type: "search", autocomplete: "off", oninput: () => {
      searched = input.value;
      filtered();
    } });
    controls.push(el("label", {}, "Search", input));
  }
  const id = newId("table");
  show();
  return el("div", { class: "data-table" },
    controls.length > 0 && el("div", { class: "controls" }, ...controls),
    // A scrollable region must be reachable by keyboard.
    el("div", { class: "scroll", role: "region", tabindex: 0, "aria-labelledby": id },
      el("table", {}, el("caption", { id }, spec.caption), el("thead", {}, el("tr", {}, ...heads)), body)),
    (controls.length > 0 || spec.rows.length > pageRows) && count,
    more);
}
