// Sharing: a link that contains the scene itself, and downloads. A link sends nothing to a server.

import { addressWith, inAddress } from "./address";
import { byId, download, fromBase64 } from "./dom";
import { connection } from "./connection";
import { editor } from "./editor";
import { files } from "./files";
import { outside } from "./outside";
import { overlays } from "./overlays";
import { say, unsay } from "./status";
import { setText } from "./visible";

/** Maximum length of a scene in a link, in characters. Browsers limit the length of an address, so
 * a link to a longer scene might not open. When a link is read, the limit stops the unpacking of
 * data that would become a huge text. */
const LONGEST = 1_000_000;
const KEY = "scene";
const NO_COPY = "The browser does not let the page copy: copy the selected link yourself.";

export async function packed(text: string): Promise<string> {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const binary = Array.from(bytes, byte => String.fromCharCode(byte));
  return btoa(binary.join("")).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

async function unpacked(text: string): Promise<string> {
  const bytes = fromBase64(text.replaceAll("-", "+").replaceAll("_", "/"));
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"))
    .pipeThrough(new TextDecoderStream("utf-8", { fatal: true })).getReader();
  let scene = "";
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return scene;
    scene += value;
    if (scene.length > LONGEST) throw new Error("it is too long");
  }
}

/** Compressed scene that was last read from the page's address; null if there was none. */
let known: string | null = null;

const DAMAGED = "The link is damaged: its scene cannot be read.";

/** Returns the scene in the page's address. Returns null if there is none or it was read before. */
export async function sceneInAddress(): Promise<string | null> {
  unsay(DAMAGED);
  const held = inAddress(KEY);
  if (held === null || held === known) return null;
  known = held;
  try {
    return await unpacked(held);
  } catch {
    say(DAMAGED, "warning");
    return null;
  }
}

/** Shows the progress of a download. `share` is the finished fraction of the work, from 0 to 1. */
export function showProgress(share: number): void {
  byId<HTMLProgressElement>("progress").value = share;
  setText(byId("percent"), `${Number((100 * share).toPrecision(3))} %`);
}

const stem = () => files.current.name.replace(/\.scn$/, "");
const rendering = byId("rendering");
/** Downloads a file that the server renders. By default, `params` contains the text of the scene.
 * `part` is added to the end of the file's name. */
export async function render(kind: "png" | "exr", type: string, part = "",
  params: object = { text: editor.text }): Promise<void> {
  if (!rendering.hidden) return say("Another picture is being made.", "warning");
  const name = `${stem()}${part}.${kind}`;
  say(`Rendering ${name}…`);
  const wanted = new AbortController();
  byId("cancel").onclick = () => wanted.abort(new Error(`${name} was cancelled.`));
  showProgress(0);
  rendering.hidden = false;
  try {
    const answer = await connection.request<Record<typeof kind, string>>(
      `studio/${kind}`, params, wanted.signal);
    download(name, fromBase64(answer[kind]), type);
    say(`${name} is downloaded.`);
  } catch (error) {
    say((error as Error).message, "warning");
  } finally { rendering.hidden = true; }
}
byId("download-png").addEventListener("click", () => void render("png", "image/png"));
byId("download-exr").addEventListener("click", () => void render("exr", "image/x-exr"));
for (const id of ["download-scene", "connection-download"]) byId(id).addEventListener("click", () =>
  download(`${stem()}.scn`, files.textToSave, "text/plain"));
byId("download-outside").addEventListener("click", () => void outside.asSvg().then(
  svg => download(`${stem()}-outside.svg`, svg, "image/svg+xml"),
  error => say((error as Error).message, "warning")));

const dialog = byId<HTMLDialogElement>("share-dialog");
const field = byId<HTMLInputElement>("share-link");
byId("copy").addEventListener("click", () => {
  field.select();
  const copied = () => (dialog.close(), say("The link is copied."));
  void navigator.clipboard.writeText(field.value).then(copied, () => say(NO_COPY, "warning"));
});
byId("share").addEventListener("click", async () => {
  if (editor.text.length > LONGEST) return say(
    "The scene is too long for a link: give away its file.", "warning");
  const { shownLayers } = overlays;
  field.value = addressWith(KEY, await packed(editor.text))
    + (shownLayers === "" ? "" : `&show=${shownLayers}`) + outside.linkFragment;
  dialog.showModal();
  field.select();
});
