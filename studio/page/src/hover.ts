// Shows the name of the object under the pointer in the footer, and draws its outline.

import { newestOf } from "./dom";
import { editor } from "./editor";
import { outside } from "./outside";
import { overlays } from "./overlays";
import { picture } from "./picture";
import type { Pick, Point } from "./protocol";
import { point as tell } from "./status";

/** Position of the pointer over the picture, in screen pixels; null if it is elsewhere. */
export let place: Point | null = null;

picture.stage.addEventListener("pointermove", event => {
  place = event.pointerType === "touch" ? null : picture.local(event);
  if (event.buttons !== 0) return tell("");
  outside.point(place && picture.toPicture(place));
  hoverAgain();
});
picture.stage.addEventListener("pointerleave", () => {
  place = null;
  outside.point(null);
  void hover(null);
});

/** Returns the point of the picture under the pointer; null if the pointer is elsewhere. */
export function pointedAt(): Point | null { return place && picture.toPicture(place); }

/** Requests the object under the pointer again, because the picture may have changed. */
export function hoverAgain(): void { if (place !== null) void hover(picture.toPicture(place)); }

const hover = newestOf(async (at: Point | null) => {
  const pick = at && await editor.ask<Pick>("pinhole/pick", { point: at });
  tell(pick?.text ?? "");
  overlays.hover(pick?.object?.index ?? null);
});
