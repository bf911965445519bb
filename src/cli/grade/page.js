const body = document.querySelector("tbody");
for (const button of document.querySelectorAll("thead button")) {
  button.addEventListener("click", () => {
    const head = button.parentElement;
    const order = head.ariaSort === "ascending" ? "descending" : "ascending";
    for (const other of document.querySelectorAll("th[aria-sort]")) other.ariaSort = "none";
    head.ariaSort = order;
    const text = row => { const cell = row.cells[head.cellIndex]; return cell.dataset.key ?? cell.textContent; };
    // Numbers come before texts, and empty cells last, in either order.
    const rank = row => (text(row) === "" ? 2 : isNaN(text(row)) ? 1 : 0);
    const compare = (a, b) => (rank(a) === 0 ? text(a) - text(b) : text(a).localeCompare(text(b)));
    const sign = order === "ascending" ? 1 : -1;
    body.append(...[...body.rows].sort((a, b) => rank(a) - rank(b) || sign * compare(a, b)));
  });
}
const dialog = document.querySelector("dialog");
for (const button of document.querySelectorAll(".open")) {
  button.addEventListener("click", () => {
    dialog.querySelector("h2").textContent = button.dataset.name;
    const figures = ["picture", "exact", "difference"].map(what => {
      const figure = document.createElement("figure");
      const caption = document.createElement("figcaption");
      caption.textContent = { picture: "as handed in", exact: "exact", difference: "where they differ" }[what];
      const image = new Image();
      image.alt = caption.textContent;
      image.src = button.dataset[what];
      figure.append(caption, image);
      return figure;
    });
    dialog.querySelector("div").replaceChildren(...figures);
    dialog.showModal();
  });
}
for (const button of document.querySelectorAll(".copy")) {
  button.addEventListener("click", async () => {
    const text = button.previousElementSibling;
    try {
      await navigator.clipboard.writeText(text.textContent);
    } catch {
      // A page from a file may be denied the clipboard; the selected text can be copied by hand.
      getSelection().selectAllChildren(text);
      document.execCommand("copy");
    }
    button.textContent = "copied";
  });
}
// On paper, folded details cannot be opened.
addEventListener("beforeprint", () => {
  for (const details of document.querySelectorAll("details")) details.open = true;
});
