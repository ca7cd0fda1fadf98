// The list of records: filters, order, and choice by mouse or keys. A page of rows stands in the document at a time.
Explore.MOST_ROWS = 50;
Explore.shown = Explore.records.map((_, row) => row); // rows that fit, in the order of the table
Explore.sorted = { key: "record_id", descending: false };
Explore.first = 0; // place in `shown` of the first row in the document
Explore.indicatorShown = null; // a column that the table has besides its own
Explore.ranges = new Map(); // name of a column -> [from, to], as chosen in the histogram

Explore.columnsShown = () => [...Explore.data.table, ...(Explore.indicatorShown ? [[Explore.indicatorShown.name, Explore.indicatorShown.title]] : [])];

Explore.compare = (a, b) => {
  if (typeof a === "string" || typeof b === "string") return String(a ?? "").localeCompare(String(b ?? ""));
  const [left, right] = [a, b].map((value) => (Number.isFinite(value) ? value : -Infinity));
  return left < right ? -1 : Number(left > right);
};

Explore.textOf = (record) => Explore.data.table.map(([key]) => record[key] ?? "").join(" ").toLowerCase();
Explore.same = (value, text) => (typeof value === "number" ? value === Number(text) : value === text);

Explore.filterRecords = () => {
  const text = Explore.part("text").value.toLowerCase();
  const chosen = [...document.querySelectorAll("[data-filter]")].filter((select) => select.value !== "");
  const ranges = [...Explore.ranges].map(([name, [from, to]]) => [Explore.columnValues(Explore.columnOf.get(name)), from, to]);
  const fits = (record, row) =>
    chosen.every((select) => Explore.same(record[select.dataset.filter], select.value)) &&
    ranges.every(([values, from, to]) => values[row] !== null && values[row] >= from && values[row] <= to) &&
    (!text || Explore.textOf(record).includes(text));
  const { key, descending } = Explore.sorted;
  const values = Explore.columnValues(Explore.columnOf.get(key));
  const rows = Explore.records.flatMap((record, row) => (fits(record, row) ? [row] : []));
  Explore.shown = rows.sort((a, b) => Explore.compare(values[a], values[b]) * (descending ? -1 : 1));
  Explore.first = 0;
  const all = Explore.records.length;
  Explore.part("count").textContent = `${Explore.shown.length} of ${all} ${Explore.data.measured ? "recordings" : "records"} shown`;
};

Explore.afterFilter = () => {
  Explore.filterRecords();
  Explore.drawTable();
  Explore.drawHistogram();
  Explore.drawScatter();
  Explore.drawWaterfall();
};

Explore.drawHead = () => {
  const line = Explore.element("tr");
  for (const [key, title] of Explore.columnsShown()) {
    const head = Explore.element("th", "", { scope: "col" });
    if (key === Explore.sorted.key) head.setAttribute("aria-sort", Explore.sorted.descending ? "descending" : "ascending");
    head.append(Explore.element("button", title, { type: "button", "data-key": key }));
    line.append(head);
  }
  Explore.part("table").querySelector("thead").replaceChildren(line);
};

Explore.cell = (value) => {
  if (typeof value !== "string") return Explore.element("td", Number.isFinite(value) ? Explore.number(value) : "", { class: "number" });
  const cell = Explore.element("td", "", value === "wrongly" ? { class: "wrong" } : {});
  if (value === "seen in training") cell.title = "The model was trained or chosen on this gearbox: naming it rightly says nothing about others.";
  cell.append(Explore.element("bdi", value));
  return cell;
};

Explore.drawTable = () => {
  Explore.drawHead();
  const rows = Explore.shown.slice(Explore.first, Explore.first + Explore.MOST_ROWS);
  const columns = Explore.columnsShown().slice(1).map(([key]) => Explore.columnValues(Explore.columnOf.get(key)));
  const lines = rows.map((row) => {
    const line = Explore.element("tr", "", { "data-row": row });
    const head = Explore.element("th", "", { scope: "row" });
    head.append(Explore.element("button", String(Explore.records[row].record_id), { type: "button", tabindex: "-1" }));
    line.append(head, ...columns.map((values) => Explore.cell(values[row])));
    return line;
  });
  Explore.part("table").querySelector("tbody").replaceChildren(...lines);
  Explore.drawTurn();
  Explore.markRow();
};

// Buttons to the rows before and after, where there are more than the document holds.
Explore.drawTurn = () => {
  const all = Explore.shown.length;
  const last = Math.min(Explore.first + Explore.MOST_ROWS, all);
  const button = (text, to, possible) => {
    const made = Explore.element("button", text, { type: "button", ...(possible ? {} : { disabled: "" }) });
    made.addEventListener("click", () => Explore.turnTo(to));
    return made;
  };
  const parts = [
    button("first", 0, Explore.first > 0),
    button("before", Explore.first - Explore.MOST_ROWS, Explore.first > 0),
    Explore.element("span", `rows ${Explore.first + 1} to ${last} of ${all}`, { role: "status" }),
    button("after", last, last < all),
    button("last", all - 1, last < all),
  ];
  Explore.part("turn").replaceChildren(...(all > Explore.MOST_ROWS ? parts : []));
};

Explore.turnTo = (place) => {
  Explore.first = Math.max(0, Math.floor(place / Explore.MOST_ROWS) * Explore.MOST_ROWS);
  Explore.drawTable();
};

// One row of the table takes part in the order of the Tab key: the chosen one, or the first that is shown.
Explore.markRow = () => {
  const lines = [...Explore.part("table").querySelectorAll("tbody tr")];
  const own = lines.find((line) => Number(line.dataset.row) === Explore.chosen);
  for (const line of lines) {
    if (line === own) line.setAttribute("aria-current", "true");
    else line.removeAttribute("aria-current");
    line.querySelector("button").tabIndex = line === (own || lines[0]) ? 0 : -1;
  }
  if (own) Explore.bringIntoView(own);
};

// Scrolls the table alone: the page stays where the reader looks.
Explore.bringIntoView = (line) => {
  const box = line.closest(".scroll");
  const head = Explore.part("table").querySelector("thead").offsetHeight;
  const top = line.offsetTop - head;
  if (top < box.scrollTop) box.scrollTop = top;
  else if (line.offsetTop + line.offsetHeight > box.scrollTop + box.clientHeight) box.scrollTop = line.offsetTop + line.offsetHeight - box.clientHeight;
};

// The record that a key leads to, on whichever page of rows it stands.
Explore.step = (row, key) => {
  const at = Explore.shown.indexOf(row);
  const last = Explore.shown.length - 1;
  const to = { ArrowDown: at + 1, ArrowUp: at - 1, PageDown: at + Explore.MOST_ROWS, PageUp: at - Explore.MOST_ROWS, Home: 0, End: last }[key];
  return to === undefined ? null : Math.min(Math.max(to, 0), last);
};

// Shows an indicator as a column of the table and upwards in the scatter.
Explore.showIndicator = (name) => {
  const fits = (column) => column.indicator && (column.name === name || column.name.startsWith(`${name}__`));
  Explore.indicatorShown = name ? Explore.columns.find(fits) ?? null : null;
  if (Explore.indicatorShown) {
    Explore.pair[1] = Explore.indicatorShown;
    Explore.byColumn = Explore.indicatorShown;
  }
};

// Says what the address asked for and the page does not have.
Explore.showAsked = (wanted) => {
  const record = wanted.get("record");
  const lost = [];
  if (record !== null && !Explore.rowOf.has(Number(record))) lost.push(`Record ${record} is not on this page.`);
  if (wanted.get("indicator") && !Explore.indicatorShown) lost.push(`No record of this page has the indicator ${wanted.get("indicator")}.`);
  if (record === null && !Explore.shown.length) lost.push("No record of this page is as the link asks for.");
  Explore.part("asked").textContent = lost.join(" ");
  Explore.part("asked").hidden = !lost.length;
};

// What the address asks for: `#record=12`, or values of the filters such as `#state=severe&predicted=healthy`, and
// `indicator=fm4_pinion`, whose values are shown then. Returns the row of the record, or -1.
Explore.address = () => {
  const wanted = new URLSearchParams(location.hash.includes("=") ? location.hash.slice(1) : "");
  for (const select of document.querySelectorAll("[data-filter]")) {
    const value = wanted.get(select.dataset.filter) ?? "";
    const fits = [...select.options].find((option) => option.value === value);
    select.value = fits ? value : "";
  }
  Explore.part("text").value = wanted.get("text") ?? "";
  Explore.ranges.clear();
  Explore.showIndicator(wanted.get("indicator"));
  Explore.filterRecords();
  Explore.showAsked(wanted);
  return Explore.rowOf.get(Number(wanted.get("record") ?? NaN)) ?? -1;
};

Explore.buildFilters = () => {
  const form = Explore.part("filters");
  const text = Explore.element("label", "Contains ");
  text.append(Explore.element("input", "", { type: "search", id: "look-text", autocomplete: "off" }));
  form.append(text);
  for (const [name, title] of Explore.data.filters) {
    const label = Explore.element("label", `${title} `);
    const select = Explore.element("select", "", { "data-filter": name });
    select.append(Explore.element("option", "all", { value: "" }));
    const values = [...new Set(Explore.columnValues(Explore.columnOf.get(name)))].filter((value) => value !== null).sort(Explore.compare);
    for (const value of values) select.append(Explore.element("option", typeof value === "string" ? value : Explore.number(value), { value }));
    label.append(select);
    form.append(label);
  }
  const all = Explore.element("button", "all records", { type: "reset" });
  form.append(all);
  form.addEventListener("input", Explore.afterFilter);
  form.addEventListener("reset", () => {
    Explore.ranges.clear();
    setTimeout(Explore.afterFilter, 0);
  });
  form.addEventListener("submit", (event) => event.preventDefault());
};

Explore.listen = () => {
  const table = Explore.part("table");
  table.querySelector("thead").addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (!button) return;
    const { key } = button.dataset;
    Explore.sorted = { key, descending: Explore.sorted.key === key && !Explore.sorted.descending };
    Explore.filterRecords();
    Explore.drawTable();
    table.querySelector(`thead button[data-key="${CSS.escape(key)}"]`).focus();
  });
  const body = table.querySelector("tbody");
  body.addEventListener("click", (event) => {
    const line = event.target.closest("tr");
    if (line) Explore.open(Number(line.dataset.row));
  });
  body.addEventListener("keydown", (event) => {
    const to = Explore.step(Number(event.target.closest("tr").dataset.row), event.key);
    if (to === null) return;
    event.preventDefault();
    if (to < Explore.first || to >= Explore.first + Explore.MOST_ROWS) Explore.turnTo(to);
    body.querySelector(`tr[data-row="${Explore.shown[to]}"] button`).focus({ preventScroll: true });
    Explore.open(Explore.shown[to]);
  });
};
