// What the orders of spectra count: of a planetary set turns of the sun against its carrier.
Explore.planetary = () => Explore.data.planetary;
// Teeth of the first and the last gear of the first mesh.
Explore.meshTeeth = (row) => [0, -1].map((place) => Explore.records[row][Explore.data.teeth.at(place)]);
Explore.orderWords = () => (Explore.planetary() ? `order of the ${Explore.data.gears[0]} against the carrier` : `${Explore.data.gears[0]} order`);
Explore.turnWords = () => (Explore.planetary() ? `turns of the ${Explore.data.gears[0]} against the carrier` : `${Explore.data.gears[0]} revolutions`);

// Order spectrum with its difference from the healthy record, and the envelope spectrum.
Explore.orders = (count, step) => Array.from({ length: count }, (_, k) => k * step);

Explore.minus = (left, right) => left.map((value, k) => (value === null || right[k] === null ? null : value - right[k]));

Explore.spectrumMarks = (row) => (first, last) => {
  const [driver, driven] = Explore.meshTeeth(row);
  const found = [];
  for (let h = Math.max(1, Math.ceil(first / driver)); h * driver <= last; h++) found.push({ at: h * driver, text: `mesh ${h}` });
  if (last - first > 1.2 * driver || Explore.planetary()) return found;
  for (let h = Math.max(1, Math.floor(first / driver)); h * driver <= last + driver; h++)
    for (let k = 1; k <= 6; k++)
      for (const side of [-1, 1]) {
        found.push({ at: h * driver + side * k, faint: true, text: k <= 3 ? `${side > 0 ? "+" : "−"}${k} ${Explore.data.gears[0]}` : "" });
        if (last - first < driver / 3) found.push({ at: h * driver + (side * k * driver) / driven, faint: true, colour: "accent", text: "" });
      }
  return found;
};

Explore.showSpectrum = (section, row, channel, healthy) => {
  const body = section.querySelector(".body");
  Explore.clear(body);
  const view = Explore.view(row, channel);
  if (!view.spectrum) return void body.append(Explore.element("p", view.missing, { class: "note" }));
  const own = Explore.values(view.spectrum);
  const x = Explore.orders(own.length, Explore.data.order_step);
  const other = healthy === null ? null : Explore.view(healthy, channel);
  const base = other && other.spectrum ? Explore.values(other.spectrum) : null;
  const range = [0, x[x.length - 1]];
  const top = own.reduce((found, value, k) => (k && value !== null && value > own[found] ? k : found), 1);
  const series = [Explore.line("record", "record")];
  if (base) series.push(Explore.line(Explore.otherName(), "healthy", { alpha: 0.6 }));
  const shared = { x: Explore.orderWords(), range, marks: Explore.spectrumMarks(row), group: "orders" };
  Explore.chart(body, {
    ...shared, title: "Order spectrum", y: `dB over 1 ${Explore.quantityOf(channel).unit}`, series, data: base ? [x, own, base] : [x, own],
    summary: `Strongest line at order ${Explore.number(x[top])} with ${Explore.number(own[top])} dB.`,
    caption: `Hann amplitude over whole ${Explore.turnWords()}; a point is the largest line near it.${Explore.planetary() ? " Planets that pass move lines off the mesh frequency." : ` Zoom to a mesh line for its sidebands: ${Explore.data.gears[0]}, and nearer still ${Explore.data.gears[1]}.`}`,
  });
  if (!base) return;
  Explore.chart(body, {
    ...shared, title: `Difference from the ${Explore.otherName()} record`, y: "dB", height: 170, data: [x, Explore.minus(own, base)], series: [Explore.line(`record minus ${Explore.otherName()}`, "record")],
    caption: "Record minus the one laid over, point by point. Between the lines this is the noise of both.",
  });
};

Explore.envelopeMarks = (row) => (first, last) => {
  const [driver, driven] = Explore.meshTeeth(row);
  const found = [];
  const [fast, slow] = Explore.planetary() ? [Explore.data.gears[0], "carrier"] : Explore.data.gears;
  for (let k = 1; k <= 4; k++) found.push({ at: k, text: k < 3 ? `${k}× ${fast}` : "" }, { at: (k * driver) / driven, faint: true, colour: "accent", text: last - first < 4 && k < 3 ? `${k}× ${slow}` : "" });
  found.push({ at: driver, text: "mesh" });
  return found;
};

Explore.showEnvelope = (section, row, channel, healthy) => {
  const body = section.querySelector(".body");
  Explore.clear(body);
  const view = Explore.view(row, channel);
  if (!view.envelope) return void body.append(Explore.element("p", view.missing, { class: "note" }));
  const own = Explore.values(view.envelope);
  const x = Explore.orders(own.length, Explore.data.envelope_step);
  const other = healthy === null ? null : Explore.view(healthy, channel);
  const base = other && other.envelope ? Explore.values(other.envelope) : null;
  const series = [Explore.line("record", "record")];
  if (base) series.push(Explore.line(Explore.otherName(), "healthy", { alpha: 0.6 }));
  const top = own.reduce((found, value, k) => (value !== null && value > own[found] ? k : found), 1);
  Explore.chart(body, {
    title: "Envelope spectrum", x: Explore.orderWords(), y: `amplitude [${Explore.quantityOf(channel).unit}]`, series, data: base ? [x, own, base] : [x, own], range: [0, x[x.length - 1]], marks: Explore.envelopeMarks(row),
    summary: `Strongest line at order ${Explore.number(x[top])}.`,
    caption: "Envelope of everything above half the mesh order. A local fault repeats once per revolution of its shaft: lines at its order and multiples.",
  });
};
