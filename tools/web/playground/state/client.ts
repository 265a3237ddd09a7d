// The page's bench, set once at start.
import type { Client } from "../bench/client.ts";

let client: Client | undefined;

export function setClient(one: Client): void {
  client = one;
}

export function bench(): Client {
  if (client === undefined) throw new Error("the bench was not started");
  return client;
}
