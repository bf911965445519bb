/** The scenes of Pinhole's folder of examples: names and texts, put in when the page is built. */
declare const EXAMPLES: [string, string][];
/** The scene that one starts from. */
declare const EMPTY: string;
