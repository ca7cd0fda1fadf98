// Synchronous averages of both shafts over their teeth, with what is left without the mean tooth.
Explore.withoutMeanTooth = (average, steps) => {
  const teeth = average.length / steps;
  const mean = Array.from({ length: steps }, (_, k) => {
    let sum = 0;
    for (let tooth = 0; tooth < teeth; tooth++) sum += average[tooth * steps + k];
    return sum / teeth;
  });
  return average.map((value, k) => value - mean[k % steps]);
};

Explore.shaft = "";

Explore.toothMarks = (row, gear, numbered) => (first, last) => {
  const found = [];
  if (numbered)
    for (const [which, tooth] of Explore.damagedTeeth(row)) if (which === gear) found.push({ at: tooth, to: tooth + 1, colour: "damage", text: `tooth ${tooth}` });
  return found.length > 14 ? found.map((mark) => ({ ...mark, text: "" })) : found;
};

Explore.showAverages = (section, row, channel, healthy) => {
  const body = section.querySelector(".body");
  const controls = section.querySelector(".controls");
  Explore.clear(body);
  const label = Explore.element("label", "Shaft ");
  const select = Explore.element("select", "", { id: "look-shaft" });
  if (!Explore.data.gears.includes(Explore.shaft)) Explore.shaft = Explore.data.gears[0];
  for (const name of Explore.data.gears) select.append(Explore.element("option", name, { value: name }));
  select.value = Explore.shaft;
  select.addEventListener("change", () => {
    Explore.shaft = select.value;
    Explore.showAverages(section, row, channel, healthy);
    Explore.part("shaft").focus();
  });
  label.append(select);
  controls.replaceChildren(label);
  const place = Explore.data.gears.indexOf(Explore.shaft);
  const view = Explore.view(row, channel);
  if (!view.averages) return void body.append(Explore.element("p", view.missing, { class: "note" }));
  const average = view.averages[place];
  if (!average) return void body.append(Explore.element("p", `The record holds too few revolutions of the ${Explore.shaft}.`, { class: "note" }));
  Explore.drawAverages(body, row, channel, average, Explore.healthyAverage(healthy, channel, place, average));
};

// The healthy record's average where it can be laid over: as many teeth, both counted from the same tooth; never that of
// another machine, whose teeth are others.
Explore.healthyAverage = (healthy, channel, place, own) => {
  const averages = healthy === null || Explore.besides() ? null : Explore.view(healthy, channel).averages;
  const found = averages && averages[place];
  return found && found.numbered && own.numbered ? Explore.values(found) : null;
};

Explore.drawAverages = (body, row, channel, packed, base) => {
  const steps = Explore.data.steps_per_tooth;
  const own = Explore.values(packed);
  const x = own.map((_, k) => k / steps);
  const both = (values) => (base ? [x, values(base), values(own)] : [x, values(own)]);
  const series = () => (base ? [Explore.line(Explore.otherName(), "healthy", { alpha: 0.75 }), Explore.line("record", "record")] : [Explore.line("record", "record")]);
  const marks = Explore.toothMarks(row, Explore.shaft, packed.numbered);
  const shared = { x: packed.numbered ? `tooth of the ${Explore.shaft}` : `teeth of the ${Explore.shaft} in a turn`, y: Explore.quantityOf(channel).unit, range: [0, own.length / steps], marks, group: "teeth" };
  const mark = packed.numbered ? "Shaded: one pitch from where a damaged tooth enters contact; the structure rings on after it." : "The set does not say which tooth the first pulse meets, so that no tooth is marked.";
  Explore.chart(body, { ...shared, title: "Synchronous average", data: both((values) => values), series: series(), caption: `Mean over ${packed.turns} revolutions of the ${Explore.shaft}. ${mark}` });
  Explore.chart(body, { ...shared, title: "Without the mean tooth", height: 190, data: both((values) => Explore.withoutMeanTooth(values, steps)), series: series(), caption: "Average minus the mean of all its teeth: all mesh harmonics are gone, what differs from tooth to tooth stays." });
  if (base) Explore.chart(body, { ...shared, title: `Difference from the ${Explore.otherName()} record`, height: 190, data: [x, Explore.minus(own, base)], series: [Explore.line(`record minus ${Explore.otherName()}`, "record")], caption: "Record minus the one laid over, at the same tooth." });
};
