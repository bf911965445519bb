// What is under the pointer: it is named in the footer, and outlined.

import { editor } from "./editor";
import { overlays } from "./overlays";
import { picture } from "./picture";
import type { Pick, Point, Samples } from "./protocol";
import { nameOf } from "./selection";
import { point as tell } from "./status";

let isBusy = false;
/** Where the pointer is on the stage, and where it has been told of last. */
let place: Point | null = null;
let next: Point | null = null;

picture.stage.addEventListener("pointermove", event => {
  place = event.pointerType === "touch" ? null : picture.local(event);
  if (event.buttons !== 0) tell("");
  else hoverAgain();
});
picture.stage.addEventListener("pointerleave", () => {
  next = place = null;
  overlays.hover(null);
  overlays.showSamples([0, 0], null);
  tell("");
});

/** Something else may be seen where the pointer is. */
export function hoverAgain(): void { if (place !== null) void at(picture.toPicture(place)); }

/** While one answer is awaited, only the newest place is remembered. */
async function at(point: Point): Promise<void> {
  next = point;
  if (isBusy) return;
  isBusy = true;
  while (next !== null) {
    const at: Point = next;
    next = null;
    const isInside = picture.isInside(at);
    const pick = isInside ? await editor.ask<Pick>("pinhole/pick", { point: at }) : null;
    tell(pick === null ? "" : described(pick, at));
    overlays.hover(pick?.object?.index ?? null);
    if (pick === null || !overlays.isOn("samples")) continue;
    const pixel: Point = [Math.floor(at[0]), Math.floor(at[1])];
    overlays.showSamples(pixel, await editor.ask<Samples>("pinhole/samples", { pixel }));
  }
  isBusy = false;
}

/** A sentence on what is seen at a point. */
function described({ object, point, distance, color }: Pick, at: Point): string {
  const pixel = `pixel ${Math.floor(at[0])}, ${Math.floor(at[1])}`;
  const place = point?.map(short).join(", ");
  if (!object || !place || distance === null) return `background ${color} · ${pixel}`;
  return `${nameOf(object)} at (${place}) · ${short(distance)} away · ${color} · ${pixel}`;
}

function short(value: number): string { return String(Number(value.toPrecision(4))); }
