// Brings the parts together: what is chosen, and what then is drawn.
Explore.chosen = null;

Explore.teeth = (record) => {
  const teeth = Explore.data.teeth.map((name) => record[name]);
  return `${teeth.slice(0, -1).join(", ")} and ${teeth.at(-1)}`;
};

Explore.facts = (row) => {
  const record = Explore.records[row];
  const area = record.damaged_area_mm2 ? `, ${Explore.number(record.damaged_area_mm2)} mm² damaged` : "";
  const load = record.torque_nm === null ? "" : `, load ${Explore.number(record.torque_nm)}`;
  if (Explore.isRecording(row)) return `${record.name}, ${record.state}, ${Explore.data.gears[0]} ${Explore.number(record.speed_hz)} Hz${load}, ${Explore.teeth(record)} teeth.`;
  const age = record.age_h === undefined ? "" : `, ${Explore.number(record.age_h)} h old`;
  return `Gearbox ${record.specimen_id}${age}, ${Explore.number(record.speed_hz)} Hz, ${Explore.number(record.torque_nm)} N m, ${Explore.teeth(record)} teeth${area}, ${record.split}${record.predicted === undefined ? "" : `, ${record.named} named ${record.predicted}`}.`;
};

Explore.isRecording = (row) => Explore.data.measured || Explore.records[row].kind === "recording";
Explore.channel = () => Explore.part("channel").value;

// Whether records are laid over the other side: a recording over a simulated record, and the other way round.
Explore.besides = () => Explore.part("laid")?.value === "beside";
Explore.otherOf = (row) => (Explore.besides() ? Explore.beside : Explore.overlay)[row];
Explore.healthyOf = (row) => (Explore.part("overlay").checked && Explore.detail(Explore.otherOf(row)) ? Explore.otherOf(row) : null);
Explore.otherName = () => (!Explore.besides() ? "healthy" : Explore.isRecording(Explore.chosen) ? "simulated" : "recording");

Explore.showOverlayNote = (row) => {
  const note = Explore.part("overlay-note");
  const other = Explore.otherOf(row);
  note.hidden = !Explore.part("overlay").checked;
  const measured = Explore.isRecording(row);
  const laid = other === null ? null : Explore.records[other];
  if (Explore.besides()) {
    const what = laid === null ? "" : `${laid.fault === "healthy" ? "healthy " : ""}${measured ? `simulated record ${laid.record_id}` : `recording ${laid.name}`}`;
    note.textContent = laid === null ? "The other side has no record: nothing is laid over." : `Laid over: ${what}, ${Explore.number(laid.speed_hz)} Hz, the nearest in speed. Angles count from each one's first pulse; averages by tooth are not laid over, since these are other teeth.`;
    return;
  }
  note.textContent = measured
    ? laid === null ? "No other recording is known to be healthy: nothing is laid over." : `Laid over: ${laid.name}, the healthy recording nearest in speed.`
    : laid === null
    ? "There is no other healthy record of this gearbox at this operating point: nothing is laid over."
    : `Laid over: record ${laid.record_id}, healthy, same gearbox and operating point.`;
};

Explore.open = (row) => {
  Explore.chosen = row;
  const record = Explore.records[row];
  const recording = Explore.isRecording(row);
  Explore.part("title").replaceChildren(`${recording ? "Recording" : "Record"} ${record.record_id}: `, Explore.element("bdi", recording ? record.name : record.state));
  Explore.part("facts").textContent = Explore.facts(row);
  const place = Explore.shown.indexOf(row);
  if (place >= 0 && (place < Explore.first || place >= Explore.first + Explore.MOST_ROWS)) Explore.turnTo(place);
  Explore.markRow();
  [row, Explore.otherOf(row)].forEach(Explore.load);
  Explore.draw();
};

Explore.draw = () => {
  const row = Explore.chosen;
  const detail = Explore.detail(row);
  Explore.part("views").hidden = !detail;
  const part = Explore.part;
  if (!detail) {
    part("overlay-note").hidden = false;
    part("overlay-note").textContent = "This page does not hold the signal of this record. `siggen-diagnostics explore SET --full` puts more on the page.";
    return void Explore.drawScatter();
  }
  const channel = Explore.channel();
  const healthy = Explore.healthyOf(row);
  Explore.showOverlayNote(row);
  Explore.showWaveform(part("waveform"), row, channel, healthy);
  Explore.showSpectrum(part("spectrum"), row, channel, healthy);
  Explore.showEnvelope(part("envelope"), row, channel, healthy);
  Explore.showAverages(part("averages"), row, channel, healthy);
  Explore.showInternals(part("internals"), row, healthy);
  Explore.showFlank(part("flank"), row);
  Explore.showLife(part("life"), row);
  Explore.showIndicators(part("indicators"), row, channel);
  Explore.drawScatter();
};

Explore.drawAll = () => {
  Explore.drawTable();
  Explore.drawHistogram();
  Explore.drawWaterfall();
  Explore.draw();
};

// Charts are drawn before the page knows that it is printed: dark ones would be pale on paper, and wide ones cut.
Explore.PAPER = 330; // half a sheet [px]
Explore.drawForPaper = (printed) => {
  document.documentElement.classList.toggle("print", printed);
  if (matchMedia("(prefers-color-scheme: dark)").matches) Explore.drawAll();
  if (!printed) return Explore.resize();
  for (const plot of Explore.plots.values()) plot.setSize({ width: Explore.PAPER, height: plot.height });
};

// Channel, and what the chosen record is laid over.
Explore.buildOver = () => {
  const box = Explore.part("over");
  const select = (id, title, options) => {
    const label = Explore.element("label", `${title} `);
    const made = Explore.element("select", "", { id: `look-${id}` });
    for (const [value, text] of options) made.append(Explore.element("option", text, { value }));
    label.append(made);
    return label;
  };
  const over = Explore.element("label");
  const said = Explore.beside ? "laid over" : Explore.data.measured ? "healthy recording of this machine" : "healthy record of the same gearbox";
  const tick = Explore.element("input", "", { type: "checkbox", id: "look-overlay" });
  tick.checked = true;
  over.append(tick, ` ${said}`);
  box.append(select("channel", "Channel", Explore.data.channels.map((name) => [name, name])), over);
  if (Explore.beside) box.append(select("laid", "Laid over", [["beside", "recording and simulation, nearest in speed"], ["own", "healthy one of the same machine"]]));
  Explore.part("channel").addEventListener("change", () => { Explore.draw(); Explore.drawWaterfall(); });
  box.addEventListener("change", (event) => event.target.id !== "look-channel" && Explore.open(Explore.chosen));
};

// What the set does not give, and of how many records the model knows the gearbox.
Explore.showMissing = () => {
  const { missing, seen } = Explore.data;
  Explore.part("seen").hidden = !seen;
  Explore.part("seen").textContent = seen;
  const box = Explore.part("missing");
  box.hidden = !missing.length;
  box.querySelector("summary").textContent = `What ${Explore.data.measured ? "recordings do" : "this set does"} not give (${missing.length})`;
  box.querySelector("ul").replaceChildren(...missing.map((text) => Explore.element("li", text)));
};

Explore.firstRow = () => {
  const damaged = Explore.shown.find((row) => !Explore.isHealthy(row) && Explore.hasDetail(row));
  return damaged ?? Explore.shown.find(Explore.hasDetail) ?? Explore.shown[0] ?? 0;
};

Explore.followAddress = () => {
  if (!location.hash.includes("=")) return;
  const row = Explore.address();
  for (const choice of [Explore.byChoice, ...Explore.pairChoices]) choice.refresh();
  Explore.chosen = row >= 0 ? row : Explore.shown[0] ?? Explore.chosen;
  Explore.drawTable();
  Explore.drawHistogram();
  Explore.drawWaterfall();
  Explore.open(Explore.chosen);
  Explore.part(row >= 0 ? "chosen" : "filters").scrollIntoView();
};

Explore.begin = () => {
  Explore.showMissing();
  Explore.buildFilters();
  Explore.buildScatter();
  Explore.buildHistogram();
  Explore.buildOver();
  Explore.buildWaterfall();
  Explore.listen();
  Explore.address();
  Explore.chosen = Explore.firstRow();
  if (location.hash.includes("=")) Explore.followAddress();
  else {
    Explore.drawTable();
    Explore.drawHistogram();
    Explore.open(Explore.chosen);
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", Explore.drawAll);
  addEventListener("resize", Explore.resize);
  addEventListener("beforeprint", () => Explore.drawForPaper(true));
  addEventListener("afterprint", () => Explore.drawForPaper(false));
  addEventListener("hashchange", Explore.followAddress);
};

Explore.begin();
