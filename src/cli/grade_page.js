for (const head of document.querySelectorAll("th")) {
  head.addEventListener("click", () => {
    const body = document.querySelector("tbody");
    const text = row => row.cells[head.cellIndex].textContent;
    // Numbers come before texts, and no text last.
    const key = row => (text(row) === "" ? 2 : isNaN(text(row)) ? 1 : 0);
    const rows = [...body.rows];
    const before = rows.map(text).join("\n");
    rows.sort((a, b) => key(a) - key(b) || (key(a) === 0 ? text(a) - text(b) : text(a).localeCompare(text(b))));
    if (rows.map(text).join("\n") === before) rows.reverse();
    body.append(...rows);
  });
}
