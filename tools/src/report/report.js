"use strict";
// Texts of points at the pointer, in place of the browser's own, which come late and not on phones.
{
  const tip = document.createElement("div");
  tip.id = "tip";
  tip.hidden = true;
  document.body.append(tip);
  for (const title of document.querySelectorAll("svg title")) {
    title.parentNode.dataset.tip = title.textContent;
    title.remove();
  }
  const show = (event) => {
    const target = event.target.closest?.("[data-tip]");
    tip.hidden = !target;
    if (!target) return;
    tip.textContent = target.dataset.tip;
    const { width, height } = tip.getBoundingClientRect();
    const x = Math.min(event.clientX + 12, innerWidth - width - 4);
    const y = event.clientY - height - 12;
    tip.style.left = `${Math.max(4, x)}px`;
    tip.style.top = `${y < 4 ? event.clientY + 16 : y}px`;
  };
  addEventListener("pointermove", show);
  addEventListener("pointerdown", show);
  addEventListener("scroll", () => { tip.hidden = true; }, true);
}
// Tables sort by a column when its title is pressed, the other way round when it is pressed again.
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  if (body.rows.length < 2) continue;
  for (const [column, cell] of [...table.tHead.rows[0].cells].entries()) {
    const button = document.createElement("button");
    button.append(...cell.childNodes);
    cell.append(button);
    button.addEventListener("click", () => {
      const sign = cell.ariaSort === "ascending" ? -1 : 1;
      for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
      cell.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
      const key = (row) => {
        const number = row.cells[column]?.dataset.v;
        return number === undefined ? row.cells[column]?.textContent ?? "" : Number(number);
      };
      const compare = (a, b) => {
        if (typeof a === "number" && typeof b === "number") {
          // What has no value stands last.
          if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
          return sign * (a - b);
        }
        return sign * String(a).localeCompare(String(b), "en", { numeric: true });
      };
      body.append(...[...body.rows].sort((a, b) => compare(key(a), key(b))));
    });
  }
}
// A picture that is open closes with the escape key.
addEventListener("keydown", (event) => {
  if (event.key === "Escape" && location.hash.startsWith("#picture-")) location.hash = "#pictures";
});
