// What is under the pointer: it is named in the footer, and outlined.

import { newestOf } from "./dom";
import { editor } from "./editor";
import { overlays } from "./overlays";
import { picture } from "./picture";
import type { Pick, Point, Samples } from "./protocol";
import { point as tell } from "./status";

/** Where the pointer is on the stage. */
let place: Point | null = null;

picture.stage.addEventListener("pointermove", event => {
  place = event.pointerType === "touch" ? null : picture.local(event);
  if (event.buttons !== 0) tell("");
  else hoverAgain();
});
picture.stage.addEventListener("pointerleave", () => {
  place = null;
  void hover(null);
});

/** Something else may be seen where the pointer is. */
export function hoverAgain(): void { if (place !== null) void hover(picture.toPicture(place)); }

const hover = newestOf(async (at: Point | null) => {
  const pick = at && await editor.ask<Pick>("pinhole/pick", { point: at });
  tell(pick?.text ?? "");
  overlays.hover(pick?.object?.index ?? null);
  const pixel = pick?.pixel;
  if (!pixel || !overlays.isOn("samples")) return overlays.showSamples(null);
  const samples = await editor.ask<Samples>("pinhole/samples", { pixel });
  overlays.showSamples(samples && { pixel, samples });
});
