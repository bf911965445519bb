// Pictures of the newest text: a coarse one at once, then finer ones, to what the scene asks for.
// The newest text wins; the last good picture stays while it has errors.

import { connection } from "./connection";
import { fromBase64 } from "./dom";
import { editor } from "./editor";
import { isSuperseded, type Frame, type Overlays } from "./protocol";

/** How fine a picture is. */
export type Fineness = "coarse" | "sharp" | "final";

export interface Shown {
  bitmap: ImageBitmap;
  size: [number, number];
  fineness: Fineness;
  /** The version of the text that it shows. */
  version: number;
}

/** A coarse picture has about so many pixels: a sixteenth of 1280 × 720. */
const COARSE_PIXELS = 320 * 180;

/** More than this a canvas cannot hold in every browser. */
const MOST_PIXELS = 16_000_000;
const LONGEST_SIDE = 8192;
/** While something is dragged, finer pictures wait so many milliseconds for the hand to rest. */
const HAND_RESTS = 20;
/** If finished pictures take fewer milliseconds, none comes between it and the coarse one. */
const SOON = 200;

class Frames {
  onShow: (shown: Shown) => void = () => {};
  /** Told whether the newest text has a picture, or what kept it from having one. */
  onState: (state: "good" | "broken" | Error) => void = () => {};
  /** Told when what was dragged is let go of. */
  onRest: () => void = () => {};
  /** What is being dragged. */
  dragging: object | null = null;
  /** Settles when the newest text's coarse picture has come, or will not come. */
  coarse: Promise<unknown> = Promise.resolve();

  private generation = 0;
  private shown = 0;
  private size: [number, number] = [1280, 720];
  private lastTook = Infinity;

  /** What was dragged is no more, unless something else is dragged already. */
  released(dragged: object): void {
    if (this.dragging === dragged) this.dragging = null;
    this.onRest();
  }

  /** The text has changed, or the server: pictures are asked for. */
  changed(): void {
    if (editor.uri === "" || connection.state !== "open") return;
    const [width, height] = this.size;
    const least = Math.ceil(Math.max(width / LONGEST_SIDE, height / LONGEST_SIDE,
      Math.sqrt((width * height) / MOST_PIXELS), 1));
    const coarse = Math.max(least, Math.round(Math.sqrt((width * height) / COARSE_PIXELS)));
    const generation = ++this.generation;
    const answer = this.ask({ scale: coarse, samples: 1 });
    this.coarse = answer.catch(() => {});
    void this.refine(generation, answer, least, coarse > least);
  }

  private async refine(generation: number, coarse: Promise<Frame | null>, least: number,
    isSharper: boolean): Promise<void> {
    if (!(await this.present(generation, "coarse", coarse))) return;
    if (this.dragging !== null) await new Promise(resolve => setTimeout(resolve, HAND_RESTS));
    if (generation !== this.generation) return;
    if (isSharper && this.lastTook > SOON
      && !(await this.present(generation, "sharp", this.ask({ scale: least, samples: 1 })))) return;
    const begin = performance.now();
    const isNewest = await this.present(generation, "final", this.ask({ scale: least }));
    if (isNewest) this.lastTook = performance.now() - begin;
  }

  private ask(how: { scale: number; samples?: number }): Promise<Frame | null> {
    return editor.request("pinhole/frame", how);
  }

  /** Shows a picture that was asked for. Says whether its text is still the newest. */
  private async present(generation: number, fineness: Fineness,
    answer: Promise<Frame | null>): Promise<boolean> {
    try {
      const frame = await answer;
      if (frame === null) {
        if (generation === this.generation) this.onState("broken");
        return false;
      }
      const bitmap = await decoded(fromBase64(frame.png));
      if (generation < this.shown) {
        bitmap.close();
        return false;
      }
      this.shown = generation;
      this.size = frame.size;
      this.onShow({ bitmap, size: frame.size, fineness, version: frame.version });
      this.onState("good");
      return generation === this.generation;
    } catch (error) {
      if (isSuperseded(error) || generation !== this.generation
        || connection.state !== "open") return false;
      this.onState(error as Error);
      void this.resize(generation);
      return false;
    }
  }

  /** A picture was refused: it may have been too large, as it has another size than was thought. */
  private async resize(generation: number): Promise<void> {
    const seen = await editor.ask<Overlays>("pinhole/overlays", { only: [] });
    const isOther = seen !== null && String(seen.size) !== String(this.size);
    if (generation !== this.generation || !isOther) return;
    this.size = seen.size;
    this.changed();
  }
}

/** The picture in the bytes of a PNG. Browsers with a decoder have it some milliseconds sooner
 *  than through a Blob, which other processes hand on. */
async function decoded(data: Uint8Array<ArrayBuffer>): Promise<ImageBitmap> {
  const how = { type: "image/png", colorSpaceConversion: "none" } as const;
  if (!("ImageDecoder" in window)) return createImageBitmap(new Blob([data], how), how);
  const decoder = new ImageDecoder({ ...how, data });
  const { image } = await decoder.decode().finally(() => decoder.close());
  return createImageBitmap(image).finally(() => image.close());
}

export const frames = new Frames();
