// The readers' messages: where they advise the program's --columns, the page has buttons.
import { withoutOptions } from "../state/advice.ts";
import { openAgain } from "./drop.ts";

/** What a list of columns means, in words. */
function meaningOf(columns: string): string {
  if (/\bc[xyz]\b|cxcywh/.test(columns)) return "centre and size";
  if (/\b(w|width|xywh)\b/.test(columns)) return "corner and size";
  return "minima and maxima";
}

export function FileAdvice({ text: message }: { text: string }) {
  const { text, ways } = withoutOptions(message);
  return (
    <div>
      <p>{text}</p>
      {ways.length > 0 && <div class="row">{ways.map((columns) => (
        <button key={columns} type="button" onClick={() => void openAgain(columns)}>
          Read as {meaningOf(columns)}: <code>{columns}</code></button>))}</div>}
    </div>
  );
}
