// The engine (the language server) in a web worker. It exchanges JSON texts with the page. Between
// slices of work it reads new messages, so that a newer change can replace the work on an old one.

import init, { Engine } from "pinhole-engine";

function run(engine: Engine): void {
  const slices = new MessageChannel();
  let isPlanned = false;
  const say = (texts: string[]) => {
    for (const text of texts) postMessage(text);
    if (isPlanned || !engine.isBusy()) return;
    isPlanned = true;
    // Texts that arrive before this null message are handled before the next slice of work.
    slices.port2.postMessage(null);
  };
  slices.port1.onmessage = () => {
    isPlanned = false;
    say(engine.advance());
  };
  addEventListener("message", ({ data }: MessageEvent<string>) => say(engine.handle(data)));
  say([engine.greeting()]);
}

// The page learns of an exception in a timer, but not of an unhandled rejection.
const fail = (error: unknown) => setTimeout(() => { throw error; });
const wasm = new URL("pinhole_bg.wasm", import.meta.url);
init({ module_or_path: wasm }).then(() => run(new Engine()), fail);
