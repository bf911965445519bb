// The part of the page's address behind #: `key=value`, joined by `&`. Browsers send it to nobody.
// This module comes before all others, so that nothing else ever sees the token there.

import { remember, remembered } from "./dom";

/** What has the token in the address, and in what the tab remembers. */
const TOKEN = "token";
const parts = () => new URLSearchParams(location.hash.slice(1));

/** The value of a key; null if it is not there. */
export function inAddress(key: string): string | null { return parts().get(key); }

/** The page's address with this value of a key, and nothing else behind #. */
export function addressWith(key: string, value: string): string {
  return `${location.origin}${location.pathname}#${key}=${value}`;
}

/** Takes the token, and nothing else, out of the address; null if there is none. */
export function takeToken(): string | null {
  const rest = parts();
  const token = rest.get(TOKEN);
  if (token === null) return null;
  rest.delete(TOKEN);
  history.replaceState(history.state, "",
    location.pathname + location.search + String(rest).replace(/^./, "#$&"));
  return token;
}

/** What the host knows this tab by. Reloading keeps it, and another tab has its own. */
export const session = {
  token: remembered(TOKEN, "sessionStorage"),
  /** Whether the token comes from an address that was just opened. */
  isFresh: false,

  /** Keeps the token that the host has given, or that an address has. */
  keep(token: string, from: "host" | "address"): void {
    Object.assign(this, { token, isFresh: from === "address" });
    // A browser that forbids it wants the printed address after reloading.
    remember(TOKEN, token, "sessionStorage");
  },
};

const token = takeToken();
if (token !== null) session.keep(token, "address");
