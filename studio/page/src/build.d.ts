// What the page is built with: the module that `npm run site` makes of studio/engine, and scenes.

declare module "pinhole-engine" {
  export class Engine {
    greeting(): string;
    handle(text: string): string[];
    advance(): string[];
    isBusy(): boolean;
  }
  export function initSync(options: { module: BufferSource }): void;
  export default function init(options: { module_or_path: URL }): Promise<unknown>;
}

/** The scenes of Pinhole's folder of examples: names and texts, put in when the page is built. */
declare const EXAMPLES: [string, string][];
/** The scene that one starts from. */
declare const EMPTY: string;
