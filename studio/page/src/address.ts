// The part of the page's address behind #: `key=value`, joined by `&`. Browsers send it to nobody.
// This module comes before all others, so that nothing else ever sees the token there.

/** What has the token in the address, and in what the tab remembers. */
const TOKEN = "token";
const REMEMBERED = "pinhole-token";

function pairs(): [string, string][] {
  const parts = location.hash.replace(/^#/, "").split("&").filter(Boolean);
  return parts.map(part => {
    const at = part.indexOf("=");
    return at < 0 ? [part, ""] : [part.slice(0, at), part.slice(at + 1)];
  });
}

/** The value of a key, as it is written; null if it is not there. */
export function inAddress(key: string): string | null {
  return pairs().find(([name]) => name === key)?.[1] ?? null;
}

/** The page's address with this value of a key, and nothing else behind #. */
export function addressWith(key: string, value: string): string {
  return `${location.origin}${location.pathname}#${key}=${value}`;
}

/** Takes the token, and nothing else, out of the address; null if there is none. */
export function takeToken(): string | null {
  const token = inAddress(TOKEN);
  if (token === null) return null;
  const rest = pairs().filter(([key]) => key !== TOKEN).map(pair => pair.join("=")).join("&");
  history.replaceState(history.state, "",
    location.pathname + location.search + (rest === "" ? "" : `#${rest}`));
  return token;
}

/** What the host knows this tab by. Reloading keeps it, and another tab has its own. */
class Session {
  token: string | null = null;
  /** Whether the token comes from an address that was just opened. */
  isFresh = false;

  constructor() {
    const token = takeToken();
    if (token !== null) this.begin(token);
    else this.token = remembered();
  }

  /** Begins with the token of an address. */
  begin(token: string): void {
    this.keep(token);
    this.isFresh = true;
  }

  /** Keeps the token that the host has given. */
  keep(token: string): void {
    this.token = token;
    this.isFresh = false;
    try {
      sessionStorage.setItem(REMEMBERED, token);
    } catch {
      // A browser that forbids it wants the printed address after reloading.
    }
  }
}

function remembered(): string | null {
  try {
    return sessionStorage.getItem(REMEMBERED);
  } catch { return null; }
}

export const session = new Session();
