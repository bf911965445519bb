// The panel of VS Code that contains the page, if there is one. VS Code's editor has the text; the
// page's own editor is hidden and has a copy of it. docs/protocol.md describes the messages.

/** Functions of VS Code for the page in a panel. The state survives a reload of the window. */
interface Panel {
  postMessage(message: string): void;
  getState(): Record<string, string> | undefined;
  setState(state: Record<string, string>): void;
}
declare const acquireVsCodeApi: (() => Panel) | undefined;

/** The panel that contains the page; undefined if the page is in a browser. */
export const panel = typeof acquireVsCodeApi === "undefined" ? undefined : acquireVsCodeApi();
