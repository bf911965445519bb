for (const head of document.querySelectorAll("th")) {
  head.addEventListener("click", () => {
    const body = document.querySelector("tbody");
    const text = row => row.cells[head.cellIndex].textContent;
    const number = row => parseFloat(text(row));
    const rows = [...body.rows];
    const before = rows.map(text).join("\n");
    rows.sort((a, b) => isNaN(number(a)) || isNaN(number(b)) ? text(a).localeCompare(text(b)) : number(a) - number(b));
    if (rows.map(text).join("\n") === before) rows.reverse();
    body.append(...rows);
  });
}
