// Indicators of the chosen record among healthy gearboxes, and the scatter of two of them.
Explore.indicatorValues = Explore.data.indicators.map((indicator) => Explore.floats(indicator.data));
Explore.indicatorName = (indicator) => (indicator.channel ? `${indicator.title} (${indicator.channel})` : indicator.title);

Explore.quantile = (sorted, share) => {
  const at = share * (sorted.length - 1);
  const low = Math.floor(at);
  return sorted[low] + (at - low) * (sorted[Math.min(low + 1, sorted.length - 1)] - sorted[low]);
};

// Rows of healthy records of other gearboxes: at the same operating point where these are five or more.
Explore.healthyRows = (row) => {
  const records = Explore.data.records;
  const others = records.flatMap((record, k) => (record.fault === "healthy" && record.kind !== "recording" && record.specimen_id !== records[row].specimen_id ? [k] : []));
  const near = others.filter((k) => records[k].operating_point_id === records[row].operating_point_id);
  return near.length >= 5 ? [near, "at the same operating point"] : [others, "at any operating point"];
};

Explore.place = (values, row, healthy) => {
  const value = values[row];
  const sorted = healthy.map((k) => values[k]).filter(Number.isFinite).sort((a, b) => a - b);
  if (!Number.isFinite(value) || sorted.length < 3) return { value, count: sorted.length, distance: -1 };
  const median = Explore.quantile(sorted, 0.5);
  const spread = Explore.quantile(sorted, 0.75) - Explore.quantile(sorted, 0.25);
  const below = sorted.filter((other) => other < value).length;
  return { value, median, below, count: sorted.length, distance: spread > 0 ? Math.abs(value - median) / spread : 0 };
};

Explore.MOST_INDICATORS = 20;

Explore.showIndicators = (section, row, channel) => {
  const body = section.querySelector(".body");
  const controls = section.querySelector(".controls");
  const [healthy, where] = Explore.healthyRows(row);
  const found = Explore.data.indicators
    .map((indicator, k) => ({ indicator, k, ...Explore.place(Explore.indicatorValues[k], row, healthy) }))
    .filter(({ indicator, value }) => Number.isFinite(value) && (!indicator.channel || indicator.channel === channel))
    .sort((a, b) => b.distance - a.distance);
  const label = Explore.element("label", "Indicator contains ");
  const search = Explore.element("input", "", { type: "search", autocomplete: "off" });
  label.append(search);
  const simulated = Explore.data.beside === null ? "" : "simulated ";
  const those = Explore.data.measured ? "other healthy recordings" : `${simulated}healthy records of other gearboxes`;
  const against = healthy.length < 3
    ? `This page has fewer than three ${those}: no indicator has a place among them.`
    : `Compared with ${healthy.length} ${those} on this page, ${where}. Many are looked at, so that some stand far out by chance.`;
  const fill = () => Explore.fillIndicators(body, found, search.value.toLowerCase(), against);
  search.addEventListener("input", fill);
  controls.replaceChildren(label);
  fill();
};

Explore.fillIndicators = (body, found, text, against) => {
  const matching = found.filter(({ indicator }) => indicator.title.toLowerCase().includes(text));
  const table = Explore.element("table");
  const head = Explore.element("tr");
  for (const title of ["Indicator", "Value", "Healthy median", "Distance in quartile ranges", "Above so many healthy"]) head.append(Explore.element("th", title, { scope: "col" }));
  const top = Explore.element("thead");
  top.append(head);
  const rows = Explore.element("tbody");
  for (const entry of matching.slice(0, Explore.MOST_INDICATORS)) {
    const line = Explore.element("tr");
    line.append(Explore.element("th", entry.indicator.title, { scope: "row", title: entry.indicator.definition }));
    const compared = entry.distance >= 0;
    const texts = [Explore.number(entry.value), compared ? Explore.number(entry.median) : "–", compared ? Explore.number(entry.distance) : "–", compared ? `${entry.below} of ${entry.count}` : "–"];
    for (const cell of texts) line.append(Explore.element("td", cell, { class: "number" }));
    rows.append(line);
  }
  table.append(top, rows);
  const box = Explore.element("div", "", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Indicators of the chosen record" });
  box.append(table);
  const shown = Math.min(matching.length, Explore.MOST_INDICATORS);
  body.replaceChildren(Explore.element("p", `${shown} of ${matching.length} indicators, the farthest first. ${against}`), box);
};

Explore.pair = [0, 1];

Explore.scatterData = () => {
  const [x, y] = Explore.pair.map((k) => Explore.indicatorValues[k]);
  const rows = Explore.data.records.map((_, k) => k).filter((k) => Number.isFinite(x[k]) && Number.isFinite(y[k]));
  rows.sort((a, b) => x[a] - x[b]);
  const only = (wanted) => rows.map((k) => (wanted(Explore.data.records[k], k) ? y[k] : null));
  const recorded = (record) => record.kind === "recording";
  const healthy = (record) => record.fault === "healthy" && !recorded(record);
  return { rows, data: [rows.map((k) => x[k]), only(healthy), only((record) => !healthy(record) && !recorded(record)), ...(Explore.data.beside ? [only(recorded)] : []), only((_, k) => k === Explore.chosen)] };
};

Explore.nearest = (plot, rows, left, top) => {
  const [x, y] = Explore.pair.map((k) => Explore.indicatorValues[k]);
  const distance = (k) => Math.hypot(plot.valToPos(x[k], "x") - left, plot.valToPos(y[k], "y") - top);
  const best = rows.reduce((found, k) => (found === null || distance(k) < distance(found) ? k : found), null);
  return best !== null && distance(best) < 24 ? best : null;
};

Explore.drawScatter = (section) => {
  const body = section.querySelector(".body");
  Explore.clear(body);
  if (Explore.data.indicators.length < 2) return void body.append(Explore.element("p", "No two indicators are defined in this set."));
  const { rows, data } = Explore.scatterData();
  const dots = (label, colour, size) => Explore.line(label, colour, { paths: () => null, points: { show: true, size, stroke: Explore.colour(colour), fill: Explore.colour(colour) } });
  const [x, y] = Explore.pair.map((k) => Explore.indicatorName(Explore.data.indicators[k]));
  const low = data[0][0];
  const high = data[0][data[0].length - 1];
  const margin = 0.04 * (high - low) || 1;
  const plot = Explore.chart(body, {
    title: "Scatter of two indicators", x, y, height: 340, data, range: [low - margin, high + margin], series: [dots("healthy", "healthy", 7), dots(Explore.data.measured ? "others" : "damaged", "record", 7), ...(Explore.data.beside ? [dots("recordings", "other", 9)] : []), dots("chosen", "damage", 13)],
    summary: `${rows.length} records; the table of records opens them too.`, caption: "A click on a point opens its record. Drag to zoom.", cursor: { drag: { x: true, y: true, uni: 30 } },
  });
  let from = null;
  plot.over.addEventListener("mousedown", (event) => (from = [event.clientX, event.clientY]));
  plot.over.addEventListener("click", (event) => {
    const box = plot.over.getBoundingClientRect();
    const dragged = from && Math.hypot(event.clientX - from[0], event.clientY - from[1]) > 4;
    const row = dragged ? null : Explore.nearest(plot, rows, event.clientX - box.left, event.clientY - box.top);
    if (row !== null) Explore.open(row);
  });
};

Explore.buildScatter = (section) => {
  const controls = section.querySelector(".controls");
  const names = Explore.data.indicators.map(Explore.indicatorName);
  const start = (wanted, fallback) => Math.max(Explore.data.indicators.findIndex(({ name }) => name.startsWith(wanted)), fallback);
  if (names.length > 1) Explore.pair = [start("rms__", 0), start(`fm4_${Explore.data.shafts[0]}__`, 1)];
  if (Explore.pair[0] === Explore.pair[1]) Explore.pair = [0, 1];
  ["Across", "Up"].forEach((title, axis) => {
    const label = Explore.element("label", `${title} `);
    const select = Explore.element("select");
    names.forEach((name, k) => select.append(Explore.element("option", name, { value: k })));
    select.value = Explore.pair[axis];
    select.addEventListener("change", () => {
      Explore.pair[axis] = Number(select.value);
      Explore.drawScatter(section);
    });
    label.append(select);
    controls.append(label);
  });
};

// Brings the choices above the scatter in line with what it shows.
Explore.chooseScatter = () =>
  document.querySelectorAll("#scatter .controls select").forEach((select, axis) => (select.value = Explore.pair[axis]));
