// A window for a projector, which shows only the picture. The page's tab sends it the pictures.

import { inAddress } from "./address";
import { byId, remember, remembered } from "./dom";
import type { Fineness, Shown } from "./frames";
import { picture } from "./picture";

const KEY = "projector";
const of = inAddress(KEY);
export const isProjector = of !== null;

/** Name of the broadcast channel that this tab used before it was reloaded; null if no projector
 * window has requested pictures from this tab. A reloaded tab uses the same channel, so that open
 * projector windows continue to get pictures. */
const known = remembered(KEY, "sessionStorage");
const name = of ?? known ?? `${Date.now()}-${Math.random().toString(36).slice(2)}`;
const channel = new BroadcastChannel(`pinhole-${name}`);
/** Whether a projector window has requested pictures from this tab. */
let isFed = known !== null;

/** Sends a picture to the projector windows, if any window has requested pictures. */
export function feedProjectors(shown: Shown): void { if (isFed) channel.postMessage(shown); }

if (isProjector) {
  document.body.classList.add("projector");
  channel.onmessage = ({ data }: MessageEvent<Shown>) => picture.show(data);
  channel.postMessage("ready");
} else channel.onmessage = async () => {
  isFed = true;
  remember(KEY, name, "sessionStorage");
  const { canvas, canvas: { dataset }, size, isEmpty } = picture;
  if (!isEmpty) feedProjectors({ bitmap: await createImageBitmap(canvas), size,
    fineness: dataset["fineness"] as Fineness, version: Number(dataset["version"]) });
};
byId("projector").addEventListener("click", () =>
  open(`${location.pathname}#${KEY}=${name}`, "_blank", "popup,width=1280,height=720"));
