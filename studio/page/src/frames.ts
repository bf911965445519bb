// Pictures of the newest text: first a coarse one, then finer ones, up to the scene's own samples.
// If the text changes, rendering of the older text ends. While the text has errors, pictures of its
// last version without errors are shown.

import type { Text } from "@codemirror/state";
import { connection } from "./connection";
import { fromBase64 } from "./dom";
import { editor } from "./editor";
import { isSuperseded, type Frame } from "./protocol";

/** Quality of a picture, from the worst to the best. */
export type Fineness = "coarse" | "sharp" | "final";

export interface Shown {
  bitmap: ImageBitmap;
  size: [number, number];
  fineness: Fineness;
  /** Version of the text that the picture shows. */
  version: number;
}

/** Maximum number of pixels of a coarse picture. One is rendered at each step of a drag, so it must
 * be rendered quickly; with more pixels, the picture would follow the pointer late. */
const COARSE_PIXELS = 320 * 180;

/** Maximum size of a picture: its number of pixels, and the length of each side. All browsers can
 * show pictures of this size; a larger picture is requested at a lower resolution. */
export const LARGEST = { pixels: 16_000_000, side: 8192 };
/** Pause in a drag, in ms, before finer pictures are requested. A moving pointer changes the text
 * once per refresh of the screen (17 ms at 60 Hz). With a shorter pause, finer pictures would be
 * requested in the middle of a movement. */
const HAND_RESTS = 20;
/** Threshold for the rendering time of the last final picture, in ms. Above it, a picture of full
 * size with one sample per pixel (`sharp`) is requested first, so that the user need not wait for
 * the final one. */
const SOON = 200;

/** A requested picture: the number of the request, and its text. The text is null if the picture is
 * of the last version without errors. */
interface Asked { doc: Text | null; generation: number }

/** Pictures of the newest text, seen by one camera. */
export class Frames {
  onShow: (shown: Shown) => void = () => {};
  /** Called with `good` or `broken` when the server has answered whether the newest text has
   * errors, and with the error when a request fails. */
  onState: (state: "good" | "broken" | Error) => void = () => {};
  /** Called when a drag ends. */
  onRest: () => void = () => {};
  /** The drag that is under way; null if there is none. */
  dragging: object | null = null;
  /** Promise that settles when the newest text's coarse picture is shown or has failed. Other
   * requests wait for it, so that they do not delay the picture. */
  coarse: Promise<unknown> = Promise.resolve();

  /** The picture that the page shows, with its request. The picture may be of an older text. */
  shown: Shown & Asked | null = null;

  /** `more` returns parameters that are added to each request, such as the view. */
  constructor(private readonly more: () => object = () => ({})) {}

  private generation = 0;
  /** Whether the server's newest answer about a text said that the text has errors. */
  private hasErrors = false;
  private lastFinalTime = Infinity;

  /** Ends the drag `dragged`, unless another drag has begun since. */
  released(dragged: object): void {
    if (this.dragging === dragged) this.dragging = null;
    this.onRest();
  }

  /** Requests new pictures after a change of the text or of the server. */
  changed(): void {
    if (editor.uri === "" || connection.state !== "open") return;
    const { doc } = editor.view.state;
    const asked = { doc, generation: ++this.generation };
    const answer = this.ask({ pixels: COARSE_PIXELS, samples: 1 });
    const coarse = this.present(asked, "coarse", answer);
    this.coarse = coarse.then(() => answer).catch(() => {});
    void this.refine(asked, coarse);
  }

  private async refine(asked: Asked, coarse: Promise<Frame | null>): Promise<void> {
    const frame = await coarse;
    if (frame === null) return;
    // For a second view, finer pictures are requested only after the drag, because they would delay
    // the main picture.
    if (frames.dragging !== null && this !== frames) return;
    if (frames.dragging !== null) await new Promise(resolve => setTimeout(resolve, HAND_RESTS));
    if (asked.generation !== this.generation) return;
    const isSharper = frame.width < frame.size[0];
    if (isSharper && this.lastFinalTime > SOON
      && !(await this.present(asked, "sharp", this.ask({ samples: 1 })))) return;
    const begin = performance.now();
    const isNewest = await this.present(asked, "final", this.ask({}));
    if (isNewest) this.lastFinalTime = performance.now() - begin;
  }

  private ask(how: { pixels?: number; samples?: number; last?: boolean }) {
    return editor.request<Frame | null>("pinhole/frame", { ...LARGEST, ...this.more(), ...how });
  }

  /** Shows a requested picture when it arrives. Returns the picture. Returns null if the text has
   * errors, if there is a newer text by then, or if the request fails. */
  private async present(asked: Asked, fineness: Fineness,
    answer: Promise<Frame | null>): Promise<Frame | null> {
    const isNewest = () => asked.generation === this.generation;
    try {
      const frame = await answer;
      const isFirst = fineness === "coarse" && !this.hasErrors;
      if (fineness === "coarse") this.hasErrors = frame === null;
      if (frame === null) {
        if (isNewest()) this.onState("broken");
        const before = { doc: null, generation: asked.generation - 1 };
        const isDone = this.shown?.fineness === "final"
          && this.shown.generation === before.generation;
        // Requests the final picture of the last version without errors, unless it is already
        // shown. It is requested when the text gets errors, and not again while errors remain.
        if (isFirst && !isDone) void this.present(before, "final", this.ask({ last: true }));
        return null;
      }
      const bitmap = await decoded(fromBase64(frame.png));
      if (asked.generation < (this.shown?.generation ?? 0)) {
        bitmap.close();
        return null;
      }
      const shown = { bitmap, size: frame.size, fineness, version: frame.version };
      this.shown = { ...asked, ...shown };
      this.onShow(shown);
      if (!isNewest()) return null;
      this.onState("good");
      return frame;
    } catch (error) {
      if (fineness === "coarse") this.hasErrors = false;
      if (isNewest() && !isSuperseded(error) && connection.state === "open")
        this.onState(error as Error);
      return null;
    }
  }
}

/** Decodes a PNG. `ImageDecoder` is a few milliseconds faster than `createImageBitmap`. */
async function decoded(data: Uint8Array<ArrayBuffer>): Promise<ImageBitmap> {
  const how = { type: "image/png", colorSpaceConversion: "none" } as const;
  if (!("ImageDecoder" in window)) return createImageBitmap(new Blob([data], how), how);
  const decoder = new ImageDecoder({ ...how, data });
  const { image } = await decoder.decode().finally(() => decoder.close());
  return createImageBitmap(image).finally(() => image.close());
}

export const frames = new Frames();
