// The picture alone in a window of its own, for a projector. This page feeds it: it asks no server.

import { inAddress } from "./address";
import { byId } from "./dom";
import type { Fineness } from "./frames";
import { picture } from "./picture";

/** What goes to the windows: a picture, as the bytes of an image. */
interface Fed { image: ImageBitmap; size: [number, number]; fineness: Fineness }

const KEY = "projector";
const of = inAddress(KEY);
export const isProjector = of !== null;

/** Other pages of Studio, also of this host, have channels of their own. */
const name = of ?? `${Date.now()}-${Math.random().toString(36).slice(2)}`;
const channel = new BroadcastChannel(`pinhole-${name}`);
let isFed = false;

/** Hands a picture on, as long as anybody has asked for one. */
export function feedProjectors(fed: Fed): void { if (isFed) channel.postMessage(fed); }

if (isProjector) {
  document.body.classList.add("projector");
  channel.onmessage = async ({ data: { image, size, fineness } }: MessageEvent<Fed>) =>
    picture.show({ bitmap: await createImageBitmap(image), size, fineness, version: 0 });
  channel.postMessage("ready");
} else channel.onmessage = async () => {
  isFed = true;
  const { canvas, size, isEmpty } = picture;
  const fineness = canvas.dataset["fineness"] as Fineness;
  if (!isEmpty) feedProjectors({ image: await createImageBitmap(canvas), size, fineness });
};
byId("projector").addEventListener("click", () =>
  open(`${location.pathname}#${KEY}=${name}`, "_blank", "popup,width=1280,height=720"));
