// Cleans the HTML that the language client makes of the server's Markdown. The Markdown may quote
// any text of a scene, which may contain HTML, so only plain formatting is kept.

import { visible } from "./visible";

/** The elements that Markdown can produce, except links, images and checkboxes. */
const ALLOWED = new Set(["H1", "H2", "H3", "H4", "H5", "H6", "P", "CODE", "PRE", "EM", "STRONG",
  "DEL", "UL", "OL", "LI", "BLOCKQUOTE", "TABLE", "THEAD", "TBODY", "TR", "TH", "TD", "BR", "HR"]);

/** Reduces HTML to plain formatting. A link is replaced by its text, an image by its alternative
 * text, a checkbox by a sign. Any other element that is not allowed is shown as source code. */
export function sanitized(html: string): string {
  // The parsed document has no window, so nothing in it is run or loaded.
  const { body } = new DOMParser().parseFromString(html, "text/html");
  const clean = document.createElement("div");
  copy(body, clean);
  return clean.innerHTML;
}

function copy(from: Element, to: Element): void {
  for (const node of from.childNodes) {
    if (node instanceof Text) to.append(visible(node.data));
    else if (!(node instanceof Element)) continue; // a comment
    else if (node.nodeName === "A") copy(node, to);
    else if (node.matches("img[alt]")) to.append(visible(node.getAttribute("alt") ?? ""));
    else if (node.matches("input[type=checkbox]")) to.append(node.matches("[checked]") ? "☑" : "☐");
    else if (!ALLOWED.has(node.nodeName)) to.append(visible(node.outerHTML));
    else copy(node, to.appendChild(document.createElement(node.nodeName)));
  }
}
