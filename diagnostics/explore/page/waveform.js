// The signal over turns of the first shaft: extremes of buckets, every sample of the first stretch.
Explore.wave = (row, packed) => {
  const samples = Explore.samples(packed);
  const pulses = Explore.floats(Explore.detail(row).pulses);
  const turning = pulses.length > 1;
  const x = turning ? Explore.revolutions(samples, pulses) : samples.map((sample) => sample / Explore.data.fs_hz);
  return { x, y: Explore.values(packed), fine: packed.fine, from: samples.indexOf(packed.fine[0]), turning };
};

// Series and data of a curve, over the one of the healthy record where there is one.
Explore.overlaid = (own, other) => {
  const series = [Explore.line("record", "record")];
  if (!other || other.turning !== own.turning) return { series, data: [own.x, own.y] };
  // on top and half transparent: a healthy signal is the smaller one, and would be hidden behind the record
  series.push(Explore.line(Explore.otherName(), "healthy", { alpha: 0.6 }));
  return { series, data: uPlot.join([[own.x, own.y], [other.x, other.y]]) };
};

Explore.angleLabel = (own) => (own.turning ? `${Explore.turnWords()} since the first pulse` : "time [s]");

// Angles (revolutions since the first pulse) at which a damaged tooth enters contact, within first ... last.
Explore.entries = (row, first, last) => {
  const record = Explore.records[row];
  const [driver, driven] = Explore.meshTeeth(row);
  const found = [];
  if (Explore.planetary()) return found; // which tooth meets which planet follows from the carrier, which has no pulse
  const pairs = Explore.unknown(record.start_angle_rad) ? 0 : Math.ceil(record.start_angle_rad / (2 * Math.PI)) * driver;
  for (const [gear, tooth] of Explore.damagedTeeth(row)) {
    const place = Explore.data.gears.indexOf(gear);
    if (place < 0) continue; // of a further mesh, whose shafts turn otherwise
    if (place && Explore.unknown(record.start_angle_rad)) continue;
    const teeth = place ? driven : driver;
    const start = place === 0 ? tooth : (((tooth - pairs) % teeth) + teeth) % teeth;
    const period = teeth / driver;
    for (let n = Math.floor(first / period) - 1; ; n++) {
      const at = start / driver + n * period;
      if (at > last) break;
      if (at >= first - 1) found.push({ at, to: at + 1 / driver, colour: "damage", text: `${gear} tooth ${tooth}` });
    }
  }
  return found;
};

Explore.unknown = (value) => value === undefined || value === null;

Explore.damagedTeeth = (row) => {
  const found = new Map((Explore.detail(row)?.damage ?? []).map((damage) => [`${damage.gear} ${damage.tooth}`, [damage.gear, damage.tooth]]));
  return [...found.values()];
};

Explore.waveMarks = (row, turning) => (first, last) => {
  if (!turning) return [];
  const [teeth] = Explore.meshTeeth(row);
  const found = [];
  if (last - first <= 60) for (let n = Math.ceil(first); n <= last; n++) found.push({ at: n, text: last - first <= 12 ? `rev ${n}` : "" });
  if ((last - first) * teeth <= 130)
    for (let k = Math.ceil(first * teeth); k <= last * teeth; k++) if (k % teeth) found.push({ at: k / teeth, faint: true, text: last - first < 2.2 ? String(((k % teeth) + teeth) % teeth) : "" });
  if (last - first <= 12) {
    const entries = Explore.entries(row, first, last);
    found.push(...entries.map((entry) => (entries.length > 12 ? { ...entry, text: "" } : entry)));
  }
  return found;
};

// Two revolutions from the first sample on that is kept: so near, teeth are told apart.
Explore.firstTurns = (own) => {
  const end = Math.min(own.from + own.fine[1] - own.fine[0] - 1, own.x.length - 1);
  return { min: own.x[own.from], max: own.turning ? Math.min(own.x[end], own.x[own.from] + 2) : own.x[end] };
};

Explore.showWaveform = (section, row, channel, healthy) => {
  const body = section.querySelector(".body");
  const controls = section.querySelector(".controls");
  Explore.clear(body);
  controls.replaceChildren();
  const packed = (at) => Explore.detail(at).channels[channel].wave;
  const own = Explore.wave(row, packed(row));
  const other = healthy === null ? null : Explore.wave(healthy, packed(healthy));
  const peak = own.y.reduce((found, value) => Math.max(found, Math.abs(value)), 0);
  const whole = own.fine[1] - own.fine[0] >= Explore.data.samples;
  const kept = whole ? "Every sample is here." : `Whole record: smallest and largest sample of each stretch, at their own places. Every sample from ${Explore.number(own.fine[0] / Explore.data.fs_hz)} to ${Explore.number(own.fine[1] / Explore.data.fs_hz)} s; --full keeps all.`;
  const start = Explore.firstTurns(own);
  const plot = Explore.chart(body, {
    title: "Signal", start, x: Explore.angleLabel(own), y: `${Explore.quantityOf(channel).word} [${Explore.quantityOf(channel).unit}]`, ...Explore.overlaid(own, other), group: "turns",
    range: [own.x[0], own.x[own.x.length - 1]], marks: Explore.waveMarks(row, own.turning), summary: `Largest magnitude ${Explore.number(peak)} ${Explore.quantityOf(channel).unit}.`,
    caption: `${kept} Dashed: revolutions; thin, numbered: teeth of the ${Explore.data.gears[0]} (when near enough); shaded: a damaged tooth enters contact.`,
  });
  const near = Explore.element("button", own.turning ? "first revolutions" : "first stretch", { type: "button" });
  near.addEventListener("click", () => plot.setScale("x", start));
  const all = Explore.element("button", "whole record", { type: "button" });
  all.addEventListener("click", () => Explore.reset(plot));
  controls.append(near, all);
};
