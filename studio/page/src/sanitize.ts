// Documentation comes from the server as Markdown, which the language client turns into HTML.
// Scenes can put any text into it, so nothing but plain formatting passes.

import { visible } from "./visible";

const ALLOWED = new Set(["H1", "H2", "H3", "P", "CODE", "PRE", "EM", "STRONG", "UL", "OL", "LI",
  "BR", "HR"]);

/** The HTML with elements of plain formatting alone, without attributes; of a link its text, and
 *  of all others how they were written. */
export function sanitized(html: string): string {
  // The parsed document has no window: nothing in it runs or loads.
  const { body } = new DOMParser().parseFromString(html, "text/html");
  const clean = document.createElement("div");
  copy(body, clean);
  return clean.innerHTML;
}

function copy(from: Node, to: Node): void {
  for (const node of from.childNodes) {
    if (node instanceof Text) {
      to.appendChild(document.createTextNode(visible(node.data)));
    } else if (node.nodeType === Node.ELEMENT_NODE && ALLOWED.has(node.nodeName)) {
      copy(node, to.appendChild(document.createElement(node.nodeName)));
    } else if (node.nodeName === "A") {
      copy(node, to);
    } else if (node.nodeType === Node.ELEMENT_NODE) {
      to.appendChild(document.createTextNode(visible((node as Element).outerHTML)));
    }
  }
}
