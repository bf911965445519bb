// Safe display of foreign texts. As on the command line (src/diagnostic/visible.rs), invisible
// characters, and those that change the order of text, are shown as their codes.

/** Control characters except line feeds and tabs, invisible ones, and annotation marks. */
const INVISIBLE = /(?![\n\t])[\p{Cc}\p{Default_Ignorable_Code_Point}\ufff9-\ufffb]/gu;
const BREAKS = /[\n\t\u2028\u2029]/g;
const code = (character: string): string => `\\u{${character.codePointAt(0)?.toString(16)}}`;

/** Returns a text with invisible characters shown as codes such as `\u{202e}`. */
export function visible(text: string): string { return text.replace(INVISIBLE, code); }

/** Returns a text of one line, such as a name, with line feeds and tabs as codes, too. */
export function visibleLine(text: string): string { return visible(text).replace(BREAKS, code); }

/** Shows a text in an element, unless it is there already. It is never read as HTML. */
export function setText(element: Element, text: string): void {
  const shown = visible(text);
  if (element.textContent !== shown) element.textContent = shown;
}
