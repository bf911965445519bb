// What is under the pointer: it is named in the footer, and outlined.

import type { SceneEditor } from "./editor";
import type { OverlayLayer } from "./overlays";
import type { Picture } from "./picture";
import type { Pick, Point, Samples } from "./protocol";
import { nameOf } from "./selection";
import { point as tell } from "./status";

export class Hover {
  private busy = false;
  private next: Point | null = null;
  private place: Point | null = null;

  constructor(private readonly editor: SceneEditor, private readonly picture: Picture,
    private readonly overlays: OverlayLayer) {
    picture.stage.addEventListener("pointerleave", () => this.leave());
    picture.stage.addEventListener("pointermove", event => {
      this.place = event.pointerType === "touch" ? null : picture.local(event);
      if (event.buttons !== 0) tell("");
      else this.again();
    });
  }

  /** Something else may be seen where the pointer is. */
  again(): void { if (this.place !== null) void this.at(this.picture.toPicture(this.place)); }

  /** While one answer is awaited, only the newest place is remembered. */
  private async at(point: Point): Promise<void> {
    this.next = point;
    if (this.busy) return;
    this.busy = true;
    while (this.next !== null) {
      const at: Point = this.next;
      this.next = null;
      const isInside = this.picture.isInside(at);
      const pick = isInside ? await this.editor.ask<Pick>("pinhole/pick", { point: at }) : null;
      tell(pick === null ? "" : described(pick, at));
      this.overlays.hover(pick?.object?.index ?? null);
      if (pick === null || !this.overlays.isOn("samples")) continue;
      const pixel: Point = [Math.floor(at[0]), Math.floor(at[1])];
      const samples = await this.editor.ask<Samples>("pinhole/samples", { pixel });
      this.overlays.showSamples(pixel, samples);
    }
    this.busy = false;
  }

  private leave(): void {
    this.next = this.place = null;
    this.overlays.hover(null);
    this.overlays.showSamples([0, 0], null);
    tell("");
  }
}

/** A sentence on what is seen at a point. */
function described({ object, point, distance, color }: Pick, at: Point): string {
  const pixel = `pixel ${Math.floor(at[0])}, ${Math.floor(at[1])}`;
  const place = point?.map(short).join(", ");
  if (!object || !place || distance === null) return `background ${color} · ${pixel}`;
  return `${nameOf(object)} at (${place}) · ${short(distance)} away · ${color} · ${pixel}`;
}

function short(value: number): string { return String(Number(value.toPrecision(4))); }
