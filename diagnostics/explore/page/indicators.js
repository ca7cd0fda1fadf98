// Where the chosen record stands among healthy gearboxes, by every indicator.

Explore.quantile = (sorted, share) => {
  const at = share * (sorted.length - 1);
  const low = Math.floor(at);
  return sorted[low] + (at - low) * (sorted[Math.min(low + 1, sorted.length - 1)] - sorted[low]);
};

Explore.MOST_HEALTHY = 400;

// Rows of healthy records of other gearboxes: at the same operating point where these are five or more.
Explore.healthyRows = (row) => {
  const { records } = Explore;
  const others = records.flatMap((record, k) => (record.fault === "healthy" && record.kind !== "recording" && record.specimen_id !== records[row].specimen_id ? [k] : []));
  const near = others.filter((k) => records[k].operating_point_id === records[row].operating_point_id);
  const [found, where] = near.length >= 5 ? [near, "at the same operating point"] : [others, "at any operating point"];
  const count = Math.min(found.length, Explore.MOST_HEALTHY); // evenly spread: of so many, more change no quartile
  return [Array.from({ length: count }, (_, k) => found[Math.floor((k * found.length) / count)]), where];
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

// It looks through all indicators of all healthy records, so it waits until it comes into view.
Explore.showIndicators = (section, row, channel) => {
  Explore.indicatorsWatch?.disconnect();
  Explore.indicatorsWatch = new IntersectionObserver((seen) => {
    if (!seen.some((entry) => entry.isIntersecting)) return;
    Explore.indicatorsWatch.disconnect();
    Explore.fillIndicatorsOf(section, row, channel);
  });
  Explore.indicatorsWatch.observe(section);
};

Explore.fillIndicatorsOf = (section, row, channel) => {
  const body = section.querySelector(".body");
  const controls = section.querySelector(".controls");
  const [healthy, where] = Explore.healthyRows(row);
  const found = Explore.columns
    .filter((column) => column.indicator)
    .map((column) => ({ indicator: column.indicator, ...Explore.place(Explore.columnValues(column), row, healthy) }))
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
