// The engine in a web worker: JSON texts from the page, and JSON texts back. Between two slices of its work it looks for new messages, so that a newer change
// supersedes a frame.

import init, { Engine } from "pinhole-engine";

const early: string[] = [];
const slices = new MessageChannel();
let engine: Engine | null = null;
let isPlanned = false;

function say(texts: string[]): void {
  for (const text of texts) postMessage(text);
  if (engine?.isBusy() && !isPlanned) {
    isPlanned = true;
    // Messages that have come by then are taken in before it.
    slices.port2.postMessage(null);
  }
}

slices.port1.onmessage = () => {
  isPlanned = false;
  if (engine?.isBusy()) say(engine.advance());
};

addEventListener("message", ({ data }: MessageEvent<string>) => {
  if (engine === null) early.push(data);
  else say(engine.handle(data));
});

init({ module_or_path: new URL("pinhole_bg.wasm", import.meta.url) }).then(
  () => {
    engine = new Engine();
    say([engine.greeting()]);
    for (const text of early.splice(0)) say(engine.handle(text));
  },
  // A rejection alone would not reach the page.
  error => setTimeout(() => { throw error; }),
);
