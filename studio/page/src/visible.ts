// Safe display of untrusted texts. As on the command line (src/diagnostic/visible.rs), invisible
// characters, and characters that reorder text, are shown as codes.

/** Matches control characters except LF and tab, invisible characters, and annotation marks. */
const INVISIBLE = /(?![\n\t])[\p{Cc}\p{Default_Ignorable_Code_Point}\ufff9-\ufffb]/gu;
const BREAKS = /[\n\t\u2028\u2029]/g;
const code = (character: string): string => `\\u{${character.codePointAt(0)?.toString(16)}}`;

/** Returns `text` with invisible characters replaced by codes such as `\u{202e}`. */
export function visible(text: string): string { return text.replace(INVISIBLE, code); }

/** Returns `text` as one line. Line breaks and tabs also become codes such as `\u{a}`. */
export function visibleLine(text: string): string { return visible(text).replace(BREAKS, code); }

/** Sets an element's text if it differs from the current one. The text is never parsed as HTML. */
export function setText(element: Element, text: string): void {
  const shown = visible(text);
  if (element.textContent !== shown) element.textContent = shown;
}
