// What is under the pointer: it is named in the footer, and outlined.

import { newestOf } from "./dom";
import { editor } from "./editor";
import { overlays } from "./overlays";
import { picture } from "./picture";
import type { Pick, Point, Samples } from "./protocol";
import { nameOf } from "./selection";
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
  const isInside = at !== null && picture.isInside(at);
  const pick = isInside ? await editor.ask<Pick>("pinhole/pick", { point: at }) : null;
  tell(pick === null || at === null ? "" : described(pick, at));
  overlays.hover(pick?.object?.index ?? null);
  if (pick === null || at === null || !overlays.isOn("samples")) return overlays.showSamples(null);
  const pixel: Point = [Math.floor(at[0]), Math.floor(at[1])];
  const samples = await editor.ask<Samples>("pinhole/samples", { pixel });
  overlays.showSamples(samples && { pixel, samples });
});

/** A sentence on what is seen at a point. */
function described({ object, point, distance, color }: Pick, at: Point): string {
  const pixel = `pixel ${Math.floor(at[0])}, ${Math.floor(at[1])}`;
  const place = point?.map(short).join(", ");
  if (!object || !place || distance === null) return `background ${color} · ${pixel}`;
  return `${nameOf(object)} at (${place}) · ${short(distance)} away · ${color} · ${pixel}`;
}

function short(value: number): string { return String(Number(value.toPrecision(4))); }
