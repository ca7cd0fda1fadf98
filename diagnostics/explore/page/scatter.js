// All chosen records over any two columns; a click on a point opens its record.
Explore.pair = [Explore.columns[0], Explore.columns[0]];

Explore.scatterData = () => {
  const [x, y] = Explore.pair.map(Explore.numbersOf);
  const rows = Explore.shown.filter((k) => Number.isFinite(x[k]) && Number.isFinite(y[k])).sort((a, b) => x[a] - x[b]);
  const only = (wanted) => rows.map((k) => (wanted(k) ? y[k] : null));
  const recorded = (k) => Explore.records[k].kind === "recording";
  const healthy = (k) => Explore.isHealthy(k) && !recorded(k);
  return { x, y, rows, data: [rows.map((k) => x[k]), only((k) => !healthy(k) && !recorded(k)), only(healthy), ...(Explore.beside ? [only(recorded)] : []), only((k) => k === Explore.chosen)] };
};

// Texts are drawn at the place of their name in the alphabet.
Explore.numbersOf = (column) => {
  const values = Explore.columnValues(column);
  if (column.kind !== "text") return values;
  const names = [...new Set(values)].sort(Explore.compare);
  return (column.places ??= values.map((value) => names.indexOf(value)));
};

Explore.namedAxis = (column) => {
  if (column.kind !== "text") return {};
  const names = [...new Set(Explore.columnValues(column))].sort(Explore.compare);
  return { values: (_, splits) => splits.map((value) => (Number.isInteger(value) ? names[value] ?? "" : "")) };
};

Explore.nearest = ({ x, y, rows }, plot, left, top) => {
  const distance = (k) => Math.hypot(plot.valToPos(x[k], "x") - left, plot.valToPos(y[k], "y") - top);
  const best = rows.reduce((found, k) => { const d = distance(k); return d < found[1] ? [k, d] : found; }, [null, 24]);
  return best[0];
};

Explore.drawScatter = () => {
  const body = Explore.part("scatter").querySelector(".body");
  Explore.clear(body);
  const found = Explore.scatterData();
  const { rows, data } = found;
  if (!rows.length) return void body.append(Explore.element("p", "No chosen record has values of both columns."));
  const dots = (label, colour, size) => Explore.line(label, colour, { paths: () => null, points: { show: true, size, stroke: Explore.colour(colour), fill: Explore.colour(colour) } });
  const [low, high] = [data[0][0], data[0][data[0].length - 1]];
  const margin = 0.04 * (high - low) || 1;
  const size = rows.length > 1000 ? 4 : 7;
  const plot = Explore.chart(body, {
    title: `${Explore.pair[1].title} over ${Explore.pair[0].title}`, short: "across", x: Explore.pair[0].title, y: Explore.pair[1].title, height: 300, data, range: [low - margin, high + margin],
    series: [dots(Explore.data.measured ? "others" : "damaged", "record", size), dots("healthy", "healthy", size), ...(Explore.beside ? [dots("recordings", "other", 9)] : []), dots("chosen", "damage", 13)],
    xAxis: Explore.namedAxis(Explore.pair[0]), yAxis: Explore.namedAxis(Explore.pair[1]),
    summary: `${rows.length} records; the table of records opens them too.`, caption: "A click on a point opens its record. Drag to zoom.", cursor: { drag: { x: true, y: true, uni: 30 } },
  });
  let from = null;
  plot.over.addEventListener("mousedown", (event) => (from = [event.clientX, event.clientY]));
  plot.over.addEventListener("click", (event) => {
    const box = plot.over.getBoundingClientRect();
    const dragged = from && Math.hypot(event.clientX - from[0], event.clientY - from[1]) > 4;
    const row = dragged ? null : Explore.nearest(found, plot, event.clientX - box.left, event.clientY - box.top);
    if (row !== null) Explore.open(row);
  });
};

Explore.buildScatter = () => {
  const named = (name, fallback) => Explore.columns.find((column) => column.name === name || column.name.startsWith(`${name}__`)) ?? fallback;
  const first = Explore.columns[Explore.firstIndicator] ?? Explore.columns[0];
  const best = Explore.data.ranked.map((name) => named(name)).find(Boolean) ?? first;
  const across = Explore.columnOf.get(Explore.data.measured || Explore.beside ? "speed_hz" : "damaged_area_mm2") ?? first;
  Explore.pair = [across, best ?? first];
  Explore.byColumn = best ?? first;
  Explore.pairChoices = ["Across", "Up"].map((title, axis) => Explore.columnChoice(title, () => Explore.pair[axis], (column) => {
    Explore.pair[axis] = column;
    Explore.drawScatter();
  }));
  Explore.part("scatter").querySelector(".controls").append(...Explore.pairChoices);
};
