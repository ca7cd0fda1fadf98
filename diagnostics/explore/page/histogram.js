// Records by any column: how many there are of each value, and a choice of a range by drag or by two numbers.
Explore.BINS = 40;
Explore.byColumn = Explore.columns[0];

// A select of all columns, labels first.
Explore.columnChoice = (title, chosen, changed) => {
  const label = Explore.element("label", `${title} `);
  const select = Explore.element("select");
  const groups = new Map();
  Explore.columns.forEach((column, k) => {
    if (!groups.has(column.group)) groups.set(column.group, Explore.element("optgroup", "", { label: column.group }));
    groups.get(column.group).append(Explore.element("option", column.title, { value: k }));
  });
  select.append(...groups.values());
  select.value = Explore.columns.indexOf(chosen());
  select.addEventListener("change", () => changed(Explore.columns[Number(select.value)]));
  label.append(select);
  label.refresh = () => (select.value = Explore.columns.indexOf(chosen()));
  return label;
};

Explore.isHealthy = (row) => Explore.records[row].fault === "healthy";

// Centres of bars, all records and healthy ones in each; texts have a bar each.
Explore.bars = (column, rows) => {
  const values = Explore.columnValues(column);
  const texts = column.kind === "text" ? [...new Set(values)].filter((value) => value !== null).sort(Explore.compare) : null;
  const at = texts ? (row) => texts.indexOf(values[row]) : (row) => values[row];
  const found = rows.map(at).filter((value) => value !== null && value !== -1);
  if (!found.length) return null;
  const low = texts ? -0.5 : found.reduce((a, b) => Math.min(a, b));
  const high = texts ? texts.length - 0.5 : found.reduce((a, b) => Math.max(a, b));
  const bins = texts ? texts.length : high > low ? Explore.BINS : 1;
  const width = (high - low) / bins || 1;
  const counts = [0, 1].map(() => new Array(bins).fill(0));
  for (const row of rows) {
    const value = at(row);
    if (value === null || value === -1) continue;
    const bin = Math.min(Math.floor((value - low) / width), bins - 1);
    counts[0][bin]++;
    if (Explore.isHealthy(row)) counts[1][bin]++;
  }
  return { x: counts[0].map((_, k) => low + (k + 0.5) * width), counts, texts, range: [low - (high > low ? 0 : 0.5), high > low ? high : high + 0.5] };
};

Explore.drawHistogram = () => {
  const section = Explore.part("histogram");
  const body = section.querySelector(".body");
  Explore.clear(body);
  const column = Explore.byColumn;
  const bars = Explore.bars(column, Explore.shown);
  Explore.drawRange(section, column);
  if (!bars) return void body.append(Explore.element("p", "No chosen record has a value of this column."));
  const paths = uPlot.paths.bars({ size: [0.92, 60] });
  const series = (label, colour) => Explore.line(label, colour, { paths, fill: Explore.colour(colour), width: 0 });
  const others = Explore.data.measured ? "others" : "damaged";
  const named = bars.texts && { values: (_, splits) => splits.map((value) => (Number.isInteger(value) ? bars.texts[value] ?? "" : "")) };
  Explore.chart(body, {
    title: column.title, x: column.title, short: "at", y: "records", height: 220, data: [bars.x, ...bars.counts], range: bars.range, xAxis: named || {},
    series: [series(`all, ${others} above`, "record"), series("healthy", "healthy")], scaleY: { range: (_, low, high) => [0, high || 1] },
    summary: `${Explore.shown.length} records from ${Explore.number(bars.range[0])} to ${Explore.number(bars.range[1])}.`,
    caption: bars.texts ? "Choose a value in the fields above." : "Drag to choose a range, or write its ends.",
    cursor: bars.texts ? {} : { drag: { x: true, y: false, setScale: false } },
    hooks: bars.texts ? {} : { setSelect: [(plot) => plot.select.width > 2 && Explore.chooseRange(column, plot.posToVal(plot.select.left, "x"), plot.posToVal(plot.select.left + plot.select.width, "x"))] },
  });
};

Explore.chooseRange = (column, from, to) => {
  if (Number.isFinite(from) || Number.isFinite(to)) Explore.ranges.set(column.name, [Number.isFinite(from) ? from : -Infinity, Number.isFinite(to) ? to : Infinity]);
  else Explore.ranges.delete(column.name);
  Explore.afterFilter();
};

// Ends of the range as numbers, and what can be said and copied about the column.
Explore.drawRange = (section, column) => {
  const more = section.querySelector(".more");
  const focused = more.contains(document.activeElement) ? document.activeElement.dataset.end : null;
  const parts = [];
  if (column.kind !== "text") {
    const chosen = Explore.ranges.get(column.name) ?? [-Infinity, Infinity];
    const ends = ["from", "to"].map((title, end) => {
      const label = Explore.element("label", `${title} `);
      const input = Explore.element("input", "", { type: "number", step: "any", "data-end": end });
      if (Number.isFinite(chosen[end])) input.value = Number(chosen[end].toPrecision(6));
      label.append(input);
      return [label, input];
    });
    const read = () => Explore.chooseRange(column, ...ends.map(([, input]) => (input.value === "" ? NaN : Number(input.value))));
    for (const [, input] of ends) input.addEventListener("change", read);
    const box = Explore.element("div", "", { class: "controls", role: "group", "aria-label": `Range of ${column.title}` });
    box.append(...ends.map(([label]) => label));
    parts.push(box);
  }
  if (column.indicator) parts.push(Explore.element("p", `${column.indicator.definition}.`), ...Explore.codeOf(column));
  more.replaceChildren(...parts);
  if (focused !== null) more.querySelector(`[data-end="${focused}"]`)?.focus();
};

// The lines of Python that compute an indicator, with a button that copies them.
Explore.codeOf = (column) => {
  if (!Explore.data.code) return [];
  const text = Explore.data.code.replaceAll("COLUMN", column.name);
  const code = Explore.element("pre", "", { tabindex: "0", "aria-label": `Python for ${column.title}` });
  code.append(Explore.element("code", text));
  const button = Explore.element("button", "copy the code", { type: "button" });
  button.addEventListener("click", async () => {
    const said = await navigator.clipboard?.writeText(text).then(() => "copied", () => "mark it and copy") ?? "mark it and copy";
    button.textContent = said;
  });
  return [code, button];
};

Explore.buildHistogram = () => {
  Explore.byChoice = Explore.columnChoice("Column", () => Explore.byColumn, (column) => {
    Explore.byColumn = column;
    Explore.drawHistogram();
  });
  Explore.part("histogram").querySelector(".controls").append(Explore.byChoice);
};
