// The panel's page has a copy of the scene's text. This module applies changes to the copy, and
// compares it with the editor's text. Both texts have LF as their line ends.

/** Returns `text` as the page stores it: with LF as its line ends, and without unpaired surrogates.
 */
function normal(text) {
  return text.replace(/\r\n?/g, "\n").toWellFormed();
}

/** Returns `text` after the changes of a notification `textDocument/didChange`. */
function changed(text, changes) {
  return changes.reduce((text, { range, text: inserted }) => {
    if (range === undefined) return inserted;
    return text.slice(0, offset(text, range.start)) + inserted + text.slice(offset(text, range.end));
  }, text);
}

function offset(text, { line, character }) {
  let start = 0;
  for (let i = 0; i < line; i++) start = text.indexOf("\n", start) + 1;
  return start + character;
}

/**
 * Returns the edits that turn `before` into `after`, as `{ line, from, to, lastLine, text }`. An
 * edit replaces the characters from `from` in `line` to `to` in `lastLine`. If the number of lines
 * is the same, as after a drag, each differing line has one small edit. Thus cursors and marks in
 * the editor stay where they are.
 */
function differences(before, after) {
  if (before === after) return [];
  const [old, now] = [before.split("\n"), after.split("\n")];
  if (old.length === now.length) {
    return old.flatMap((line, i) => {
      if (line === now[i]) return [];
      const { start, end } = common(line, now[i]);
      return [{ line: i, from: start, lastLine: i, to: line.length - end, text: now[i].slice(start, now[i].length - end) }];
    });
  }
  const { start, end } = common(before, after);
  const at = index => {
    const lines = before.slice(0, index).split("\n");
    return [lines.length - 1, lines.at(-1).length];
  };
  const [[line, from], [lastLine, to]] = [at(start), at(before.length - end)];
  return [{ line, from, lastLine, to, text: after.slice(start, after.length - end) }];
}

/** Returns the lengths of the longest common start and end, which do not overlap. */
function common(a, b) {
  const most = Math.min(a.length, b.length);
  let start = 0;
  while (start < most && a[start] === b[start]) start++;
  let end = 0;
  while (end < most - start && a.at(-1 - end) === b.at(-1 - end)) end++;
  return { start, end };
}

module.exports = { normal, changed, differences };
