// Pictures of the newest text: a coarse one at once, then finer ones, to what the scene asks for. The newest text wins; the last good picture stays while it has
// errors.

import type { Connection } from "./connection";
import { fromBase64 } from "./dom";
import type { SceneEditor } from "./editor";
import { isSuperseded, type Frame } from "./protocol";

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

/** While something is dragged, finer pictures wait until the hand has rested for so many milliseconds. */
const HAND_RESTS = 100;

export class Frames {
  /** Whether something is being dragged. */
  dragging = false;
  /** Settles when the newest text's coarse picture is there, or will not come. */
  coarse: Promise<void> = Promise.resolve();

  private generation = 0;
  private shown = 0;
  private size: [number, number] = [1280, 720];

  constructor(
    private readonly editor: SceneEditor,
    private readonly connection: Connection,
    private readonly show: (shown: Shown) => void,
    /** Told whether the newest text has a picture, or what kept it from having one. */
    private readonly told: (state: "good" | "broken" | Error) => void,
  ) {}

  /** The size of the scene's picture, as soon as something else knows it. */
  resized(size: [number, number]): void {
    this.size = size;
  }

  /** The text has changed, or the server: pictures are asked for. */
  changed(): void {
    if (this.editor.uri === "" || this.connection.state !== "open") return;
    const generation = ++this.generation;
    this.coarse = this.refine(generation);
  }

  private async refine(generation: number): Promise<void> {
    const [width, height] = this.size;
    const least = Math.ceil(Math.max(width / LONGEST_SIDE, height / LONGEST_SIDE, Math.sqrt((width * height) / MOST_PIXELS), 1));
    const coarse = Math.max(least, Math.round(Math.sqrt((width * height) / COARSE_PIXELS)));
    if (await this.ask(generation, "coarse", { scale: coarse, samples: 1 })) void this.sharpen(generation, coarse > least, least);
  }

  private async sharpen(generation: number, worthwhile: boolean, scale: number): Promise<void> {
    if (this.dragging) await new Promise(resolve => setTimeout(resolve, HAND_RESTS));
    if (worthwhile && !(await this.ask(generation, "sharp", { scale, samples: 1 }))) return;
    await this.ask(generation, "final", { scale });
  }

  /** Asks for a picture and shows it. Says whether it is still worth asking for finer ones. */
  private async ask(generation: number, fineness: Fineness, how: { scale: number; samples?: number }): Promise<boolean> {
    if (generation !== this.generation) return false;
    try {
      const frame = await this.connection.request<Frame | null>("pinhole/frame", this.editor.about(how));
      if (frame === null) {
        if (generation === this.generation) this.told("broken");
        return false;
      }
      const bitmap = await createImageBitmap(new Blob([fromBase64(frame.png)], { type: "image/png" }), { colorSpaceConversion: "none" });
      if (generation < this.shown) {
        bitmap.close();
        return false;
      }
      this.shown = generation;
      this.size = frame.size;
      this.show({ bitmap, size: frame.size, fineness, version: frame.version });
      this.told("good");
      return generation === this.generation;
    } catch (error) {
      if (!isSuperseded(error) && generation === this.generation && this.connection.state === "open") this.told(error as Error);
      return false;
    }
  }
}
