// Pictures of the newest text: a coarse one at once, then finer ones, to what the scene asks for.
// The newest text wins. While it has errors, the server has the pictures of the last good one.

import type { Text } from "@codemirror/state";
import { connection } from "./connection";
import { fromBase64 } from "./dom";
import { editor } from "./editor";
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

/** Maximum number of pixels of a coarse picture: a sixteenth of 1280 × 720. */
const COARSE_PIXELS = 320 * 180;

/** More than this a canvas cannot hold in every browser. */
const MOST = { pixels: 16_000_000, side: 8192 };
/** While something is dragged, finer pictures wait so many milliseconds for the hand to rest. */
const HAND_RESTS = 20;
/** If finished pictures take fewer milliseconds, none comes between it and the coarse one. */
const SOON = 200;

/** What pictures were asked of. */
interface Asked { doc: Text | null; generation: number }

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

  /** The newest picture: of which text, and by which question; the text may have changed since. */
  shown: Shown & Asked | null = null;

  private generation = 0;
  /** Whether the newest text that has an answer has errors. */
  private isBroken = false;
  private lastTook = Infinity;

  /** What was dragged is no more, unless something else is dragged already. */
  released(dragged: object): void {
    if (this.dragging === dragged) this.dragging = null;
    this.onRest();
  }

  /** The text has changed, or the server: pictures are asked for. */
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
    if (this.dragging !== null) await new Promise(resolve => setTimeout(resolve, HAND_RESTS));
    if (asked.generation !== this.generation) return;
    const isSharper = frame.width < frame.size[0];
    if (isSharper && this.lastTook > SOON
      && !(await this.present(asked, "sharp", this.ask({ samples: 1 })))) return;
    const begin = performance.now();
    const isNewest = await this.present(asked, "final", this.ask({}));
    if (isNewest) this.lastTook = performance.now() - begin;
  }

  private ask(how: { pixels?: number; samples?: number; last?: boolean }) {
    return editor.request<Frame | null>("pinhole/frame", { ...MOST, ...how });
  }

  /** Shows a picture that was asked for, and returns it if its text is still the newest. */
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
        // What stood there before is finished all the same. More mistakes do not begin it anew.
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

/** The picture in a PNG. A decoder has it some milliseconds sooner than other processes do. */
async function decoded(data: Uint8Array<ArrayBuffer>): Promise<ImageBitmap> {
  const how = { type: "image/png", colorSpaceConversion: "none" } as const;
  if (!("ImageDecoder" in window)) return createImageBitmap(new Blob([data], how), how);
  const decoder = new ImageDecoder({ ...how, data });
  const { image } = await decoder.decode().finally(() => decoder.close());
  return createImageBitmap(image).finally(() => image.close());
}

export const frames = new Frames();
