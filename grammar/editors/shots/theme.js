// Colours of VS Code's dark theme for the types of the server's tokens.

export const types = {
  keyword: "C586C0",
  property: "9CDCFE",
  variable: "4FC1FF",
  class: "4EC9B0",
  function: "DCDCAA",
  enumMember: "CE9178",
  number: "B5CEA8",
  operator: "D4D4D4",
  comment: "6A9955",
};

export const colors = {
  "editor.background": "#1F1F1F",
  "editor.foreground": "#CCCCCC",
  "editorLineNumber.foreground": "#6E7681",
  "editorLineNumber.activeForeground": "#6E7681",
  "editorInlayHint.foreground": "#969696",
  "editorInlayHint.background": "#3A3D4166",
  "editorHoverWidget.background": "#202020",
  "editorHoverWidget.border": "#454545",
  "editorSuggestWidget.background": "#202020",
  "editorSuggestWidget.border": "#454545",
  "editorSuggestWidget.selectedBackground": "#04395E",
  "editorError.foreground": "#F14C4C",
  "editorWarning.foreground": "#CCA700",
};
