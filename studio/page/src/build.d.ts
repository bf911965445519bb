// Types of modules and constants that the build provides: the engine, which `npm run site` makes
// from studio/engine, and the texts of scenes and lessons.

declare module "pinhole-engine" {
  export class Engine {
    greeting(): string;
    handle(text: string): string[];
    advance(): string[];
    isBusy(): boolean;
  }
  export default function init(options: { module_or_path: URL }): Promise<unknown>;
}

/** Names and texts of the example scenes. The build inserts them into the page. */
declare const EXAMPLES: [string, string][];
/** The lessons, in the order of the page's list of lessons. The build inserts them. */
declare const LESSONS: { name: string; text: string; start: string }[];
/** Text of a new scene. */
declare const EMPTY: string;
