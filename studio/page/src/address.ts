// The fragment of the page's address: `key=value`, joined by `&`. Browsers do not send it. This
// module is loaded before all others, so that none of them sees the token in the address.

import { remember, remembered } from "./dom";

/** Key of the token in the address and in the tab's storage. */
const TOKEN = "token";
const parts = () => new URLSearchParams(location.hash.slice(1));

/** Returns the value of a key, or null if the address does not have it. */
export function inAddress(key: string): string | null { return parts().get(key); }

/** Returns the page's address with a fragment of one key and its value. */
export function addressWith(key: string, value: string): string {
  return `${location.origin}${location.pathname}#${key}=${value}`;
}

/** Removes the token alone from the address and returns it, or null if there is none. */
export function takeToken(): string | null {
  const rest = parts();
  const token = rest.get(TOKEN);
  if (token === null) return null;
  rest.delete(TOKEN);
  history.replaceState(history.state, "",
    location.pathname + location.search + String(rest).replace(/^./, "#$&"));
  return token;
}

/** Token by which the host knows this tab. Reloading keeps it; another tab has its own. */
export const session = {
  token: remembered(TOKEN, "sessionStorage"),
  /** Whether the token comes from an address opened just now. */
  isFresh: false,

  /** Stores the token given by the host or by an address. */
  keep(token: string, from: "host" | "address"): void {
    Object.assign(this, { token, isFresh: from === "address" });
    // A browser without storage needs the printed address after reloading.
    remember(TOKEN, token, "sessionStorage");
  },
};

const token = takeToken();
if (token !== null) session.keep(token, "address");
