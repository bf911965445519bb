// The fragment of the page's address: `key=value` pairs joined by `&`. It may contain the access
// token that the host gave to the page, since browsers send no fragment to a server. This module
// must be loaded first: it removes the token from the address before other modules read the
// address.

import { remember, remembered } from "./dom";

/** Key of the access token, both in the page's address and in the tab's storage. */
const TOKEN = "token";
const parts = () => new URLSearchParams(location.hash.slice(1));

/** Returns the value of `key` in the fragment of the page's address; null if it is absent. */
export function inAddress(key: string): string | null { return parts().get(key); }

/** Returns the page's address with the fragment `key=value`. */
export function addressWith(key: string, value: string): string {
  return `${location.origin}${location.pathname}#${key}=${value}`;
}

/** Removes the token, and nothing else, from the address. Returns the token, or null if there is
 * none. */
export function takeToken(): string | null {
  const rest = parts();
  const token = rest.get(TOKEN);
  if (token === null) return null;
  rest.delete(TOKEN);
  history.replaceState(history.state, "",
    location.pathname + location.search + String(rest).replace(/^./, "#$&"));
  return token;
}

/** Access token of this tab, by which the host recognizes it. Each tab has its own token, which
 * survives a reload. */
export const session = {
  token: remembered(TOKEN, "sessionStorage"),
  /** Whether the token was taken from the address, not from the host or the tab's storage. */
  isFresh: false,

  /** Stores a token that the host has sent or that was in the page's address. */
  keep(token: string, from: "host" | "address"): void {
    Object.assign(this, { token, isFresh: from === "address" });
    // If the browser refuses to store the token, the page works until it is reloaded. Then the user
    // must open the printed address again.
    remember(TOKEN, token, "sessionStorage");
  },
};

const token = takeToken();
if (token !== null) session.keep(token, "address");
