// Order spectra of all chosen records above each other, in the order of speed, load, damage or age.
Explore.MOST_LINES = 200;
Explore.fallBy = null;

// From dark to bright, in steps that are seen alike: viridis at nine places (Smith and van der Walt, CC0).
Explore.SHADES = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];

Explore.shade = (share) => {
  const at = Math.min(Math.max(share, 0), 1) * (Explore.SHADES.length - 1);
  const low = Math.min(Math.floor(at), Explore.SHADES.length - 2);
  return Explore.SHADES[low].map((value, k) => value + (at - low) * (Explore.SHADES[low + 1][k] - value));
};

Explore.fallChoices = () => {
  const wanted = ["speed_hz", "torque_nm", "damaged_area_mm2", "age_h"].flatMap((name) => Explore.columnOf.get(name) ?? []);
  const varying = wanted.filter((column) => new Set(Explore.columnValues(column).filter(Number.isFinite)).size > 1);
  return varying.length ? varying : [Explore.columnOf.get("record_id")];
};

// Rows whose spectra are here, by value; evenly spread over them where they are more than lines.
Explore.fallRows = (column, channel) => {
  const values = Explore.columnValues(column);
  const known = Explore.shown.filter((row) => Number.isFinite(values[row]) && Explore.hasDetail(row));
  known.sort((a, b) => values[a] - values[b]);
  const count = Math.min(known.length, Explore.MOST_LINES);
  const chosen = Array.from({ length: count }, (_, k) => known[Math.round((k * (known.length - 1)) / Math.max(count - 1, 1))]);
  return chosen.filter((row) => {
    if (!Explore.details.has(row)) Explore.details.set(row, JSON.parse(document.getElementById(`look-record-${row}`).textContent));
    return Explore.details.get(row).channels[channel].spectrum;
  });
};

Explore.hasDetail = (row) => Explore.details.has(row) || document.getElementById(`look-record-${row}`) !== null;

// The picture, a pixel for every point of every spectrum.
Explore.fallPicture = (spectra) => {
  const points = Math.max(...spectra.map((levels) => levels.length));
  const sorted = Float64Array.from(spectra.flatMap((levels) => levels.filter((value) => value !== null))).sort();
  const [low, high] = [Explore.quantile(sorted, 0.3), Explore.quantile(sorted, 0.999)];
  const canvas = Explore.element("canvas", "", { width: points, height: spectra.length });
  const context = canvas.getContext("2d");
  const image = context.createImageData(points, spectra.length);
  const shades = Array.from({ length: 256 }, (_, k) => Explore.shade(k / 255));
  spectra.forEach((levels, line) => levels.forEach((value, k) => {
    const share = value === null ? 0 : Math.min(Math.max((value - low) / (high - low || 1), 0), 1);
    image.data.set([...shades[Math.round(255 * share)], 255], 4 * ((spectra.length - 1 - line) * points + k));
  }));
  context.putImageData(image, 0, 0);
  return { canvas, points, low, high };
};

Explore.drawWaterfall = () => {
  const section = Explore.part("waterfall");
  const body = section.querySelector(".body");
  Explore.clear(body);
  if (!section.dataset.open) return;
  const channel = Explore.channel();
  const rows = Explore.fallRows(Explore.fallBy, channel);
  if (rows.length < 2) return void body.append(Explore.element("p", "Fewer than two chosen records have their spectra here."));
  const spectra = rows.map((row) => Explore.values(Explore.view(row, channel).spectrum));
  const { canvas, points, low, high } = Explore.fallPicture(spectra);
  const values = Explore.columnValues(Explore.fallBy);
  const step = Explore.data.order_step;
  const paint = (plot) => {
    const { ctx, bbox } = plot;
    const [left, right] = [-0.5, points - 0.5].map((k) => plot.valToPos(k * step, "x", true));
    const [top, bottom] = [rows.length, 0].map((line) => plot.valToPos(line, "y", true));
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.imageSmoothingEnabled = false;
    ctx.drawImage(canvas, left, top, right - left, bottom - top);
    ctx.restore();
  };
  const line = (value) => Math.min(Math.max(Math.floor(value), 0), rows.length - 1);
  const orders = [0, (points - 1) * step];
  const plot = Explore.chart(body, {
    title: "Waterfall", x: Explore.orderWords(), y: Explore.fallBy.title, height: Math.min(160 + 6 * rows.length, 520), data: [orders, [0, rows.length]], range: orders,
    series: [{ show: false }], scaleY: { range: [0, rows.length] }, bare: true,
    yAxis: { values: (_, splits) => splits.map((value) => (value >= rows.length ? "" : Explore.number(values[rows[line(value)]]))) },
    hooks: { draw: [paint] },
    summary: `${rows.length} records from ${Explore.number(values[rows[0]])} to ${Explore.number(values[rows[rows.length - 1]])} of ${Explore.fallBy.title}.`,
    caption: `${rows.length} records, a line each, by ${Explore.fallBy.title}. From dark, ${Explore.number(low)} dB and less, to bright, ${Explore.number(high)} dB, over 1 ${Explore.quantityOf(channel).unit}. A click opens a record.`,
  });
  plot.over.addEventListener("click", (event) => {
    const at = line(plot.posToVal(event.clientY - plot.over.getBoundingClientRect().top, "y"));
    if (plot.select.width < 2) Explore.open(rows[at]);
  });
};

Explore.buildWaterfall = () => {
  const section = Explore.part("waterfall");
  const controls = section.querySelector(".controls");
  const choices = Explore.fallChoices();
  Explore.fallBy = choices[0];
  const label = Explore.element("label", "In the order of ");
  const select = Explore.element("select");
  choices.forEach((column, k) => select.append(Explore.element("option", column.title, { value: k })));
  select.addEventListener("change", () => {
    Explore.fallBy = choices[Number(select.value)];
    Explore.drawWaterfall();
  });
  label.append(select);
  controls.append(label);
  // drawn when it comes into view: it unpacks the spectra of all records
  new IntersectionObserver((seen, observer) => {
    if (!seen.some((entry) => entry.isIntersecting)) return;
    observer.disconnect();
    section.dataset.open = "yes";
    Explore.drawWaterfall();
  }).observe(section);
};
