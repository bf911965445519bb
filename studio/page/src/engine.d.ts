// The module that `npm run site` makes of studio/engine.

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
