// The engine in a web worker: JSON texts from the page, and back. Between slices of work it looks
// for new ones, so that a newer change supersedes a frame. The page waits until it is greeted.

import init, { Engine } from "pinhole-engine";

function run(engine: Engine): void {
  const slices = new MessageChannel();
  let isPlanned = false;
  const say = (texts: string[]) => {
    for (const text of texts) postMessage(text);
    if (isPlanned || !engine.isBusy()) return;
    isPlanned = true;
    // Messages that have come by then are taken in before it.
    slices.port2.postMessage(null);
  };
  slices.port1.onmessage = () => {
    isPlanned = false;
    say(engine.advance());
  };
  addEventListener("message", ({ data }: MessageEvent<string>) => say(engine.handle(data)));
  say([engine.greeting()]);
}

// A rejection alone would not reach the page.
const fail = (error: unknown) => setTimeout(() => { throw error; });
const wasm = new URL("pinhole_bg.wasm", import.meta.url);
init({ module_or_path: wasm }).then(() => run(new Engine()), fail);
