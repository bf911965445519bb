// The fragment of the page's address: `key=value` pairs joined by `&`, which browsers never send.
// This module is loaded before all others, so that none of them sees the token in the address.

import { remember, remembered } from "./dom";

/** Key of the token in the address and in the tab's storage. */
const TOKEN = "token";
const parts = () => new URLSearchParams(location.hash.slice(1));

/** Returns the value of `key` in the fragment, or null if the fragment lacks the key. */
export function inAddress(key: string): string | null { return parts().get(key); }

/** Returns the page's address with the fragment `key=value`. */
export function addressWith(key: string, value: string): string {
  return `${location.origin}${location.pathname}#${key}=${value}`;
}

/** Removes only the token from the address and returns it, or null if there is none. */
export function takeToken(): string | null {
  const rest = parts();
  const token = rest.get(TOKEN);
  if (token === null) return null;
  rest.delete(TOKEN);
  history.replaceState(history.state, "",
    location.pathname + location.search + String(rest).replace(/^./, "#$&"));
  return token;
}

/** Token by which the host recognizes this tab. It survives a reload; each tab has its own. */
export const session = {
  token: remembered(TOKEN, "sessionStorage"),
  /** Whether the token was taken from the address, not from the host or the tab's storage. */
  isFresh: false,

  /** Stores the token given by the host or by an address. */
  keep(token: string, from: "host" | "address"): void {
    Object.assign(this, { token, isFresh: from === "address" });
    // Without storage, the user has to open the printed address again after a reload.
    remember(TOKEN, token, "sessionStorage");
  },
};

const token = takeToken();
if (token !== null) session.keep(token, "address");
