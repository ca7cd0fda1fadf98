// Brings the parts together: what is chosen, and what then is drawn.
Explore.chosen = null;

Explore.teeth = (record) => (record.teeth_planet ? `${record.teeth_sun}, ${record.teeth_planet} and ${record.teeth_ring}` : `${record.teeth_pinion} and ${record.teeth_gear}`);

Explore.facts = (row) => {
  const record = Explore.data.records[row];
  const area = record.damaged_area_mm2 ? `, ${Explore.number(record.damaged_area_mm2)} mm² damaged` : "";
  const load = record.torque_nm === null ? "" : `, load ${Explore.number(record.torque_nm)}`;
  if (Explore.isRecording(row)) return `${record.name}, ${record.state}, ${Explore.data.shafts[0]} ${Explore.number(record.speed_hz)} Hz${load}, ${Explore.teeth(record)} teeth.`;
  return `Gearbox ${record.specimen_id}, ${Explore.number(record.speed_hz)} Hz, ${Explore.number(record.torque_nm)} N m, ${Explore.teeth(record)} teeth${area}, ${record.split}${record.predicted === undefined ? "" : `, ${record.named} named ${record.predicted}`}.`;
};

Explore.isRecording = (row) => Explore.data.measured || Explore.data.records[row].kind === "recording";

// Whether records are laid over the other side: a recording over a simulated record, and the other way round.
Explore.besides = () => document.getElementById("laid")?.value === "beside";
Explore.otherOf = (row) => (Explore.besides() ? Explore.data.beside : Explore.data.overlay)[row];
Explore.healthyOf = (row) => (document.getElementById("overlay").checked ? Explore.otherOf(row) : null);
Explore.otherName = () => (!Explore.besides() ? "healthy" : Explore.isRecording(Explore.chosen) ? "simulated" : "recording");

Explore.showOverlayNote = (row) => {
  const note = document.getElementById("overlay-note");
  const other = Explore.otherOf(row);
  note.hidden = !document.getElementById("overlay").checked;
  const measured = Explore.isRecording(row);
  const laid = other === null ? null : Explore.data.records[other];
  if (Explore.besides()) {
    const what = laid === null ? "" : `${laid.fault === "healthy" ? "healthy " : ""}${measured ? `simulated record ${laid.record_id}` : `recording ${laid.name}`}`;
    note.textContent = laid === null ? "The other side has no record: nothing is laid over." : `Laid over: ${what}, ${Explore.number(laid.speed_hz)} Hz, the nearest in speed. Angles count from each one's first pulse; averages by tooth are not laid over, since these are other teeth.`;
    return;
  }
  note.textContent = measured
    ? laid === null ? "No other recording is known to be healthy: nothing is laid over." : `Laid over: ${laid.name}, the healthy recording nearest in speed.`
    : other === null
    ? "This page has no other healthy record of this gearbox at this operating point: nothing is laid over."
    : `Laid over: record ${Explore.data.records[other].record_id}, healthy, same gearbox and operating point.`;
};

Explore.open = (row) => {
  Explore.chosen = row;
  const record = Explore.data.records[row];
  const title = document.getElementById("chosen-title");
  title.replaceChildren(`${Explore.isRecording(row) ? "Recording" : "Record"} ${record.record_id}: `, Explore.element("bdi", Explore.isRecording(row) ? record.name : record.state));
  document.getElementById("chosen-facts").textContent = Explore.facts(row);
  Explore.markRow();
  Explore.draw();
};

Explore.draw = () => {
  const row = Explore.chosen;
  const channel = document.getElementById("channel").value;
  const healthy = Explore.healthyOf(row);
  const section = (name) => document.getElementById(name);
  Explore.showOverlayNote(row);
  Explore.showWaveform(section("waveform"), row, channel, healthy);
  Explore.showSpectrum(section("spectrum"), row, channel, healthy);
  Explore.showEnvelope(section("envelope"), row, channel, healthy);
  Explore.showAverages(section("averages"), row, channel, healthy);
  Explore.showInternals(section("internals"), row, healthy);
  Explore.showFlank(section("flank"), row);
  Explore.showLife(section("life"), row);
  Explore.showIndicators(section("indicators"), row, channel);
  Explore.drawScatter(section("scatter"));
};

// Charts are drawn before the page knows that it is printed: dark ones would be pale on paper.
Explore.drawForPaper = (printed) => {
  document.documentElement.classList.toggle("print", printed);
  if (matchMedia("(prefers-color-scheme: dark)").matches) Explore.draw();
};

Explore.begin = () => {
  Explore.listen();
  Explore.sortRecords(document.querySelector("#table th[aria-sort] button").dataset.key, false);
  Explore.buildScatter(document.getElementById("scatter"));
  const asked = Explore.address();
  Explore.chooseScatter();
  document.getElementById("channel").addEventListener("change", Explore.draw);
  document.getElementById("overlay").addEventListener("change", Explore.draw);
  document.getElementById("laid")?.addEventListener("change", Explore.draw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", Explore.draw);
  addEventListener("resize", Explore.resize);
  addEventListener("beforeprint", () => Explore.drawForPaper(true));
  addEventListener("afterprint", () => Explore.drawForPaper(false));
  addEventListener("hashchange", () => {
    const row = Explore.address();
    Explore.chooseScatter();
    const shown = Explore.visible();
    if (row >= 0) Explore.open(row);
    else if (shown.length) Explore.open(Number(shown[0].dataset.row));
  });
  const shown = Explore.visible().map((line) => Number(line.dataset.row));
  const damaged = shown.find((row) => Explore.data.records[row].fault !== "healthy");
  Explore.open(asked >= 0 ? asked : damaged ?? shown[0] ?? 0);
};

Explore.begin();
