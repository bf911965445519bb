/** A scene of the examples, as text. */
declare module "*.scn" {
  const text: string;
  export default text;
}
