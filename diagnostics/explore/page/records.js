// The table of records: sort, filter, and choice by mouse or keys.
Explore.rows = () => [...document.querySelectorAll("#table tbody tr")];
Explore.visible = () => Explore.rows().filter((line) => !line.hidden);

Explore.sortRecords = (key, descending) => {
  const body = document.querySelector("#table tbody");
  const value = (line) => Explore.data.records[line.dataset.row][key];
  const order = (a, b) => (typeof a === "string" ? a.localeCompare(b) : (a ?? -Infinity) - (b ?? -Infinity));
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

// What the address asks for: `#record=12`, or values of the filters such as `#state=severe&predicted=healthy`.
Explore.address = () => {
  const wanted = new URLSearchParams(location.hash.slice(1));
  for (const select of document.querySelectorAll("[data-filter]")) {
    const value = wanted.get(select.dataset.filter) ?? "";
    const fits = [...select.options].find((option) => option.value === value);
    select.value = fits ? value : "";
  }
  document.getElementById("filter-text").value = wanted.get("text") ?? "";
  document.getElementById("filter-size").value = wanted.get("area_from") ?? "";
  Explore.filterRecords();
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
