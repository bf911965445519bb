// The engine in a web worker, which exchanges JSON texts with the page. Between slices of work it
// reads new messages, so that a newer change supersedes a frame. Its greeting says it is ready.

import init, { Engine } from "pinhole-engine";

function run(engine: Engine): void {
  const slices = new MessageChannel();
  let isPlanned = false;
  const say = (texts: string[]) => {
    for (const text of texts) postMessage(text);
    if (isPlanned || !engine.isBusy()) return;
    isPlanned = true;
    // Messages that arrive before this one are handled before the next slice.
    slices.port2.postMessage(null);
  };
  slices.port1.onmessage = () => {
    isPlanned = false;
    say(engine.advance());
  };
  addEventListener("message", ({ data }: MessageEvent<string>) => say(engine.handle(data)));
  say([engine.greeting()]);
}

// An unhandled rejection would not be reported to the page; an exception in a timer is.
const fail = (error: unknown) => setTimeout(() => { throw error; });
const wasm = new URL("pinhole_bg.wasm", import.meta.url);
init({ module_or_path: wasm }).then(() => run(new Engine()), fail);
