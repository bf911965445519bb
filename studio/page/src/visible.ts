// Text from others, as people may see it. As on the command line (src/diagnostic/visible.rs), what
// is not seen, or has text shown in another order than it is written, stands there as its code.

/** Control characters but line feeds and tabs, invisible ones, and marks of annotations. */
const INVISIBLE = /(?![\n\t])[\p{Cc}\p{Default_Ignorable_Code_Point}\ufff9-\ufffb]/gu;
const BREAKS = /[\n\t\u2028\u2029]/g;
const code = (character: string): string => `\\u{${character.codePointAt(0)?.toString(16)}}`;

/** The text with such characters as `\u{202e}`. */
export function visible(text: string): string { return text.replace(INVISIBLE, code); }

/** A name, or another text of one line: line feeds and tabs are made visible, too. */
export function visibleLine(text: string): string { return visible(text).replace(BREAKS, code); }

/** Shows a text in an element, unless it is there. It is never read as HTML. */
export function setText(element: Element, text: string): void {
  const shown = visible(text);
  if (element.textContent !== shown) element.textContent = shown;
}
