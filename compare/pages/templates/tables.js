// Tables that can be sorted and filtered; without this they are what they are.
"use strict";

const valueOf = (cell) => {
  const data = cell.querySelector("data");
  const text = (data ? data.value : cell.textContent).trim();
  const number = Number(text);
  return text !== "" && !Number.isNaN(number) ? number : text.toLowerCase();
};

const compare = (a, b) => {
  if (typeof a === typeof b) return a < b ? -1 : a > b ? 1 : 0;
  return typeof a === "number" ? -1 : 1;
};

function sortable(table) {
  const heads = [...table.tHead.rows[0].cells], body = table.tBodies[0];
  const printed = [...body.rows];
  heads.forEach((head, k) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const before = head.getAttribute("aria-sort");
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      if (before === "descending") {
        body.append(...printed);
        return;
      }
      const sign = before === "ascending" ? -1 : 1;
      head.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
      const order = new Map(printed.map((row) => [row, valueOf(row.cells[k])]));
      body.append(...[...printed].sort((a, b) => sign * compare(order.get(a), order.get(b))));
    });
  });
}

function filtered(table) {
  const rows = [...table.tBodies[0].rows];
  const controls = document.createElement("div");
  controls.className = "controls";
  const labelled = (words, control) => {
    const label = document.createElement("label");
    label.append(words + " ", control);
    controls.append(label);
    return control;
  };
  const search = labelled("Only rows with", document.createElement("input"));
  search.type = "search";
  search.size = 12;
  const choices = ["cause", "verdict"].map((name) => {
    const values = [...new Set(rows.map((row) => row.dataset[name]).filter(Boolean))].sort();
    if (values.length < 2) return null;
    const select = labelled(name, document.createElement("select"));
    for (const value of ["", ...values]) select.append(new Option(value || "any", value));
    return [name, select];
  }).filter(Boolean);
  let flips = null;
  if (rows.some((row) => row.classList.contains("flips"))) {
    flips = labelled("wrong in print", document.createElement("input"));
    flips.type = "checkbox";
  }
  const count = document.createElement("output");
  controls.append(count);
  const apply = () => {
    const words = search.value.trim().toLowerCase();
    let shown = 0;
    for (const row of rows) {
      row.hidden = !(row.textContent.toLowerCase().includes(words)
        && choices.every(([name, select]) => !select.value || row.dataset[name] === select.value)
        && !(flips && flips.checked && !row.classList.contains("flips")));
      shown += !row.hidden;
    }
    count.textContent = shown + " of " + rows.length;
  };
  controls.addEventListener("input", apply);
  apply();
  const place = table.closest(".scroll") || table;
  place.before(controls);
}

for (const table of document.querySelectorAll("table.sortable")) {
  sortable(table);
  filtered(table);
}
