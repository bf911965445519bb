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

/** Maximum numbers of pixels of a picture and of one of its sides. All browsers can show pictures
 * of this size; a larger picture is requested at a lower resolution. */
const MOST = { pixels: 16_000_000, side: 8192 };
/** Pause in a drag, in ms, before finer pictures are requested. It is a little longer than the time
 * between two refreshes of a usual screen (17 ms). */
const HAND_RESTS = 20;
/** Rendering time, in ms. If the last final picture was rendered faster, the next one is expected
 * as soon, so no sharp picture is requested before it. */
const SOON = 200;

/** A requested picture: its text, and the number of the request. */
interface Asked { doc: Text | null; generation: number }

/** Pictures of the newest text, seen by one camera. */
export class Frames {
  onShow: (shown: Shown) => void = () => {};
  /** Called when it is known whether the newest text has errors (`broken`) or not (`good`), and
   * with the error if a request fails. */
  onState: (state: "good" | "broken" | Error) => void = () => {};
  /** Called when a drag ends. */
  onRest: () => void = () => {};
  /** The drag that is under way; null if there is none. */
  dragging: object | null = null;
  /** Settles when the newest text's coarse picture has arrived or failed. */
  coarse: Promise<unknown> = Promise.resolve();

  /** The picture that the page shows, with its request. The picture may be of an older text. */
  shown: Shown & Asked | null = null;

  /** `more` are further parameters of the requests. */
  constructor(private readonly more: () => object = () => ({})) {}

  private generation = 0;
  /** Whether the server's newest answer about a text said that the text has errors. */
  private isBroken = false;
  private lastTook = Infinity;

  /** Ends the drag `dragged`, unless another drag has begun since. */
  released(dragged: object): void {
    if (this.dragging === dragged) this.dragging = null;
    this.onRest();
  }

  /** Requests new pictures after a change of the text or of the server. */
  changed(): void {
    if (editor.uri === "" || connection.state !== "open") return;
    const answer = this.ask({ pixels: COARSE_PIXELS, samples: 1 });
    this.coarse = answer.catch(() => {});
    const { doc } = editor.view.state;
    void this.refine({ doc, generation: ++this.generation }, answer);
  }

  private async refine(asked: Asked, coarse: Promise<Frame | null>): Promise<void> {
    const frame = await this.present(asked, "coarse", coarse);
    if (frame === null) return;
    // Of a second view, finer pictures are requested when the drag has ended.
    if (frames.dragging !== null && this !== frames) return;
    if (frames.dragging !== null) await new Promise(resolve => setTimeout(resolve, HAND_RESTS));
    if (asked.generation !== this.generation) return;
    const isSharper = frame.width < frame.size[0];
    if (isSharper && this.lastTook > SOON
      && !(await this.present(asked, "sharp", this.ask({ samples: 1 })))) return;
    const begin = performance.now();
    const isNewest = await this.present(asked, "final", this.ask({}));
    if (isNewest) this.lastTook = performance.now() - begin;
  }

  private ask(how: { pixels?: number; samples?: number; last?: boolean }) {
    return editor.request<Frame | null>("pinhole/frame", { ...MOST, ...this.more(), ...how });
  }

  /** Shows a requested picture when it arrives. Returns it if its text is still the newest. */
  private async present(asked: Asked, fineness: Fineness,
    answer: Promise<Frame | null>): Promise<Frame | null> {
    const isNewest = () => asked.generation === this.generation;
    try {
      const frame = await answer;
      const isFirst = fineness === "coarse" && !this.isBroken;
      if (fineness === "coarse") this.isBroken = frame === null;
      if (frame === null) {
        if (isNewest()) this.onState("broken");
        const before = { doc: null, generation: asked.generation - 1 };
        const isDone = this.shown?.fineness === "final"
          && this.shown.generation === before.generation;
        // When the text gets errors, the final picture of its last version without errors is
        // requested, unless it is already shown. While errors remain, it is not requested again.
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
      if (fineness === "coarse") this.isBroken = false;
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
