// The engine in a web worker, which exchanges JSON texts with the page. Between slices of work it
// takes new messages, so that a newer change supersedes a frame. A greeting says that it is ready.

import init, { Engine } from "pinhole-engine";

function run(engine: Engine): void {
  const slices = new MessageChannel();
  let isPlanned = false;
  const say = (texts: string[]) => {
    for (const text of texts) postMessage(text);
    if (isPlanned || !engine.isBusy()) return;
    isPlanned = true;
    // Messages that have arrived by then are handled first.
    slices.port2.postMessage(null);
  };
  slices.port1.onmessage = () => {
    isPlanned = false;
    say(engine.advance());
  };
  addEventListener("message", ({ data }: MessageEvent<string>) => say(engine.handle(data)));
  say([engine.greeting()]);
}

// An unhandled rejection would not reach the page.
const fail = (error: unknown) => setTimeout(() => { throw error; });
const wasm = new URL("pinhole_bg.wasm", import.meta.url);
init({ module_or_path: wasm }).then(() => run(new Engine()), fail);
