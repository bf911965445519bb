// Two ways to show the page to a class with a projector. The page itself can be large, without
// header and footer. Or a second window shows only the picture, which the page's tab sends to it.

import { inAddress } from "./address";
import { byId, remember, remembered } from "./dom";
import type { Fineness, Shown } from "./frames";
import { picture } from "./picture";

const KEY = "projector";
const of = inAddress(KEY);
export const isProjector = of !== null;

/** Kinds of messages between tabs and projector windows. A window says that it is `ready` for
 * pictures, or `gone`. A tab that was just loaded sends `there`, and windows answer `ready`. If
 * another tab already uses the channel, it answers `taken`: the loaded tab is a copy of that tab,
 * and needs another channel. */
type Kind = "ready" | "gone" | "there" | "taken" | "picture";
interface Message { kind: Kind; from: string; shown?: Shown }

const unique = () => `${Date.now()}-${Math.random().toString(36).slice(2)}`;
const own = unique();
/** Projector windows that want pictures from this tab. */
const windows = new Set<string>();

/** Name of the broadcast channel. A tab keeps the name when it is reloaded, so that open projector
 * windows continue to get pictures. */
let name = of ?? remembered(KEY, "sessionStorage") ?? unique();
let channel = join();

function join(): BroadcastChannel {
  const joined = new BroadcastChannel(`pinhole-${name}`);
  const handle = isProjector ? handleInWindow : handleInTab;
  joined.onmessage = ({ data }: MessageEvent<Message>) => handle(data);
  return joined;
}

const send = (kind: Kind, shown?: Shown) => channel.postMessage({ kind, from: own, shown });

/** Sends a picture to the projector windows, if there are any. */
export function feedProjectors(shown: Shown): void { if (windows.size > 0) send("picture", shown); }

function handleInWindow({ kind, shown }: Message): void {
  if (shown) picture.show(shown);
  if (kind === "there") send("ready");
}

async function handleInTab({ kind, from }: Message): Promise<void> {
  if (kind === "gone") windows.delete(from);
  if (kind === "there") send("taken");
  if (kind === "taken") {
    channel.close();
    windows.clear();
    name = unique();
    channel = join();
  }
  if (kind !== "ready") return;
  windows.add(from);
  remember(KEY, name, "sessionStorage");
  const { canvas, canvas: { dataset }, size, isEmpty } = picture;
  if (!isEmpty) feedProjectors({ bitmap: await createImageBitmap(canvas), size,
    fineness: dataset["fineness"] as Fineness, version: Number(dataset["version"]) });
}

document.body.classList.toggle("projector", isProjector);
addEventListener("pagehide", () => send("gone"));
send(isProjector ? "ready" : "there");

/** Checkbox that makes the page large, by the rules in large.css. Its state survives a reload. */
export const large = byId<HTMLInputElement>("large");
large.checked = remembered("large", "sessionStorage") === "true";
large.addEventListener("change", () =>
  remember("large", String(large.checked), "sessionStorage"));

byId("large-end").addEventListener("click", () => large.click());
byId("projector").addEventListener("click", () =>
  open(`${location.pathname}#${KEY}=${name}`, "_blank", "popup,width=1280,height=720"));
