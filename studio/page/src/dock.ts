// The dock below the picture. It is hidden if all of its parts are hidden.

import { byId } from "./dom";

/** Shows or hides a part of the dock. */
export function showPart(part: HTMLElement, isShown: boolean): void {
  part.hidden = !isShown;
  const dock = byId("dock");
  dock.hidden = ([...dock.children] as HTMLElement[]).every(it => it.hidden);
}
