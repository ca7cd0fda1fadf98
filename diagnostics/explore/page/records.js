// The table of records: sort, filter, and choice by mouse or keys.
Explore.rows = () => [...document.querySelectorAll("#table tbody tr")];
Explore.visible = () => Explore.rows().filter((line) => !line.hidden);

Explore.sortRecords = (key, descending) => {
  const body = document.querySelector("#table tbody");
  const shown = Explore.indicatorValues[Explore.shown] ?? [];
  const value = (line) => (key === "shown" ? shown[line.dataset.row] : Explore.data.records[line.dataset.row][key]);
  const known = (number) => (Number.isFinite(number) ? number : -Infinity);
  const order = (a, b) => (typeof a === "string" ? a.localeCompare(b) : known(a) < known(b) ? -1 : Number(known(a) > known(b)));
  const lines = Explore.rows().sort((a, b) => order(value(a), value(b)) * (descending ? -1 : 1));
  body.append(...lines);
};

Explore.filterRecords = () => {
  const text = document.getElementById("filter-text").value.toLowerCase();
  const size = Number(document.getElementById("filter-size").value) || 0;
  const chosen = [...document.querySelectorAll("[data-filter]")].filter((select) => select.value !== "");
  for (const line of Explore.rows()) {
    const record = Explore.data.records[line.dataset.row];
    const fits = chosen.every((select) => Explore.same(record[select.dataset.filter], select.value));
    line.hidden = !(fits && (record.damaged_area_mm2 || 0) >= size && line.textContent.toLowerCase().includes(text));
  }
  Explore.setTabStop();
  document.getElementById("count").textContent = `${Explore.visible().length} of ${Explore.data.records.length} records shown`;
};

// An indicator as a column of the table and as the vertical axis of the scatter.
Explore.showIndicator = (name) => {
  Explore.shown = name ? Explore.data.indicators.findIndex((one) => one.name === name || one.name.startsWith(`${name}__`)) : -1;
  const found = Explore.shown >= 0;
  const head = document.getElementById("shown-indicator");
  const values = found ? Explore.indicatorValues[Explore.shown] : null;
  head.hidden = !found;
  head.querySelector("button").textContent = found ? Explore.indicatorName(Explore.data.indicators[Explore.shown]) : "";
  for (const line of Explore.rows()) {
    line.lastElementChild.hidden = !found;
    line.lastElementChild.textContent = found && Number.isFinite(values[line.dataset.row]) ? Explore.number(values[line.dataset.row]) : "";
  }
  if (found && Explore.data.indicators.length > 1) Explore.pair = [Explore.pair[0] === Explore.shown ? Explore.pair[1] : Explore.pair[0], Explore.shown];
};

// Says what the address asked for and the page does not have.
Explore.showAsked = (wanted) => {
  const note = document.getElementById("asked");
  const record = wanted.get("record");
  const lost = [];
  if (record !== null && !Explore.data.records.some((one) => String(one.record_id) === record)) lost.push(`Record ${record} is not on this page; the option --limit takes more.`);
  if (wanted.get("indicator") && Explore.shown < 0) lost.push(`No record of this page has the indicator ${wanted.get("indicator")}.`);
  if (record === null && !Explore.visible().length) lost.push("No record of this page is as the link asks for; the option --limit takes more.");
  note.textContent = lost.join(" ");
  note.hidden = !lost.length;
};

// What the address asks for: `#record=12`, or values of the filters such as `#state=severe&predicted=healthy`, and
// `indicator=fm4_pinion`, whose values are shown then.
Explore.address = () => {
  const wanted = new URLSearchParams(location.hash.slice(1));
  for (const select of document.querySelectorAll("[data-filter]")) {
    const value = wanted.get(select.dataset.filter) ?? "";
    const fits = [...select.options].find((option) => option.value === value);
    select.value = fits ? value : "";
  }
  document.getElementById("filter-text").value = wanted.get("text") ?? "";
  document.getElementById("filter-size").value = wanted.get("area_from") ?? "";
  Explore.showIndicator(wanted.get("indicator"));
  Explore.filterRecords();
  Explore.showAsked(wanted);
  return Explore.data.records.findIndex((record) => String(record.record_id) === wanted.get("record"));
};

Explore.same = (value, text) => (typeof value === "number" ? value === Number(text) : value === text);

// One row of the table takes part in the order of the Tab key: the chosen one, or the first that is shown.
Explore.setTabStop = () => {
  const shown = Explore.visible();
  const stop = shown.find((line) => Number(line.dataset.row) === Explore.chosen) || shown[0];
  for (const line of Explore.rows()) line.querySelector("button").tabIndex = line === stop ? 0 : -1;
};

Explore.markRow = () => {
  for (const line of Explore.rows()) {
    if (Number(line.dataset.row) === Explore.chosen) line.setAttribute("aria-current", "true");
    else line.removeAttribute("aria-current");
  }
  Explore.setTabStop();
  Explore.bringIntoView(document.querySelector("#table tr[aria-current]"));
};

// Scrolls the table alone: the page stays where the reader looks.
Explore.bringIntoView = (line) => {
  const box = line.closest(".scroll");
  const head = document.querySelector("#table thead").offsetHeight;
  const top = line.offsetTop - head;
  if (top < box.scrollTop) box.scrollTop = top;
  else if (line.offsetTop + line.offsetHeight > box.scrollTop + box.clientHeight) box.scrollTop = line.offsetTop + line.offsetHeight - box.clientHeight;
};

Explore.stepRow = (line, key) => {
  const shown = Explore.visible();
  const at = shown.indexOf(line);
  const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: shown.length - 1 }[key];
  return to === undefined ? null : shown[Math.min(Math.max(to, 0), shown.length - 1)];
};

Explore.listen = () => {
  const table = document.getElementById("table");
  table.querySelector("thead").addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (!button) return;
    const head = button.closest("th");
    const descending = head.getAttribute("aria-sort") === "ascending";
    for (const other of table.querySelectorAll("thead th")) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", descending ? "descending" : "ascending");
    Explore.sortRecords(button.dataset.key, descending);
  });
  const body = table.querySelector("tbody");
  body.addEventListener("click", (event) => {
    const line = event.target.closest("tr");
    if (line) Explore.open(Number(line.dataset.row));
  });
  body.addEventListener("keydown", (event) => {
    const line = Explore.stepRow(event.target.closest("tr"), event.key);
    if (!line) return;
    event.preventDefault();
    line.querySelector("button").focus({ preventScroll: true });
    Explore.open(Number(line.dataset.row));
  });
  document.getElementById("filters").addEventListener("input", Explore.filterRecords);
  document.getElementById("filters").addEventListener("submit", (event) => event.preventDefault());
};
