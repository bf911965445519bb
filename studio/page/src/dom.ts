// Helpers for the document: finding and creating elements, pointers, downloads and storage.

import { panel } from "./panel";
import { setText } from "./visible";

/** Returns the element of index.html with the id `id`. Throws an error if there is none. */
export function byId<E extends HTMLElement = HTMLElement>(id: string): E {
  const element = document.getElementById(id);
  if (element === null) throw new Error(`the page has no element #${id}`);
  return element as E;
}

/** Returns a value that the host wrote into the page's head; undefined if it is absent. */
export function meta(name: string): string | undefined {
  return document.querySelector<HTMLMetaElement>(`meta[name="pinhole-${name}"]`)?.content;
}

/** Creates an element with a class and a text. The text is never parsed as HTML. */
export function create<K extends keyof HTMLElementTagNameMap>(tag: K, className = "",
  text = ""): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  if (className !== "") element.className = className;
  if (text !== "") setText(element, text);
  return element;
}

/** Creates a button. `name` is its name for screen readers; if null, its text is used. */
export function createButton(text: string, className: string, press: () => void,
  name: string | null = null): HTMLButtonElement {
  const button = create("button", className, text);
  button.type = "button";
  if (name !== null) button.setAttribute("aria-label", name);
  button.addEventListener("click", press);
  return button;
}

export function createSvg<K extends keyof SVGElementTagNameMap>(tag: K,
  attributes: Record<string, string | number>): SVGElementTagNameMap[K] {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}

/** Calls `move` for each movement of a pressed pointer, and `end` when the pointer is released or
 * the browser cancels it. If Escape is pressed, or the returned function is called, calls `cancel`
 * instead of `end`. */
export function followPointer(pressed: PointerEvent, move: (event: PointerEvent) => void,
  end: () => void, cancel: () => void): () => void {
  const following = new AbortController();
  // Listens in the capture phase, so that Escape does not also trigger another command.
  const how = { capture: true, signal: following.signal };
  const hear = (type: "pointermove" | "pointerup" | "pointercancel",
    act: (event: PointerEvent) => void) => document.addEventListener(type,
    event => event.pointerId === pressed.pointerId && act(event), how);
  const over = (act: () => void) => {
    if (!following.signal.aborted) act();
    following.abort();
  };
  hear("pointermove", move);
  for (const type of ["pointerup", "pointercancel"] as const) hear(type, () => over(end));
  document.addEventListener("keydown", event => {
    if (event.key !== "Escape") return;
    event.stopPropagation();
    event.preventDefault();
    over(cancel);
  }, how);
  return () => over(cancel);
}

/** Wraps `act` so that its calls run one at a time. Of the waiting calls, only the newest runs. */
export function newestOf<T>(act: (it: T) => Promise<void>): (it: T) => Promise<void> {
  let next: { it: T } | null = null;
  let work: Promise<void> | null = null;
  const go = async () => {
    try {
      for (let now = next; now !== null; now = next) {
        next = null;
        await act(now.it);
      }
    } finally { work = null; }
  };
  return it => {
    next = { it };
    return (work ??= go());
  };
}

/** Makes the browser save `content` as a file. */
export function download(name: string, content: BlobPart, type: string): void {
  const link = create("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** The browser's own base64 decoder, if it has one. It is many times faster than `atob`. */
const native = Uint8Array as unknown as { fromBase64?(text: string): Uint8Array<ArrayBuffer> };

/** Decodes base64 to bytes. */
export function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  return native.fromBase64?.(text) ?? Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
}

/** Returns a setting stored in the browser, the tab or the panel. Returns null if there is none. */
export function remembered(key: string, where: Store = "localStorage"): string | null {
  if (panel) return panel.getState()?.[key] ?? null;
  try {
    return window[where].getItem(`pinhole-${key}`);
  } catch { return null; }
}

export function remember(key: string, value: string, where: Store = "localStorage"): void {
  if (panel) return panel.setState({ ...panel.getState(), [key]: value });
  try {
    window[where].setItem(`pinhole-${key}`, value);
  } catch { /* The page works without stored settings. */ }
}

type Store = "localStorage" | "sessionStorage";
