// The page's address with the state in it.
import { effect } from "@preact/signals";

import { clock, state } from "../state/store.ts";
import { writeState } from "../state/url.ts";

function base(): string {
  return location.href.replace(/[?#].*$/, "");
}

export function address(): string {
  return `${base()}#${writeState(state.value, clock.value)}`;
}

export function embedding(): string {
  const hash = writeState({ ...state.value, embed: true }, clock.value);
  const src = `${base()}#${hash}`.replace(/&/g, "&amp;").replace(/"/g, "&quot;");
  return `<iframe src="${src}" width="640" height="420" title="Broadside playground" loading="lazy"></iframe>`;
}

/** Browsers refuse too frequent changes of the address. */
const every = 400;

/** Keeps the address up to date: soon enough to be copied, but not in every frame. */
export function keepAddress(): void {
  let due: ReturnType<typeof setTimeout> | undefined;
  effect(() => {
    // Running time alone does not update the address; pausing does.
    void state.value;
    if (!state.value.playing) void clock.value;
    due ??= setTimeout(() => {
      due = undefined;
      const hash = writeState(state.value, clock.value);
      history.replaceState(null, "", hash === "" ? base() + location.search : `#${hash}`);
    }, every);
  });
}
