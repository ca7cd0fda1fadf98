// Transmission error, mesh force and mesh stiffness where the set stores them, zoomed together with the signal.
Explore.quantity = 0;

Explore.showInternals = (section, row, healthy) => {
  const body = section.querySelector(".body");
  Explore.clear(body);
  const quantities = Explore.data.quantities;
  section.hidden = !quantities.length;
  if (!quantities.length) return;
  section.querySelector(".controls").replaceChildren(Explore.quantityChoice(section, row, healthy));
  const { name, title, unit } = quantities[Explore.quantity];
  const packed = Explore.detail(row).internals[name];
  if (!packed) return void body.append(Explore.element("p", "The set stores no such quantities of this record.", { class: "note" }));
  const own = Explore.wave(row, packed);
  const base = healthy === null ? null : Explore.detail(healthy).internals[name];
  Explore.chart(body, {
    title, x: Explore.angleLabel(own), y: unit, ...Explore.overlaid(own, base && Explore.wave(healthy, base)), group: "turns", start: Explore.firstTurns(own),
    range: [own.x[0], own.x[own.x.length - 1]], marks: Explore.waveMarks(row, own.turning), caption: "Decimated like the signal, with which it zooms.",
  });
};

Explore.quantityChoice = (section, row, healthy) => {
  const label = Explore.element("label", "Quantity ");
  const select = Explore.element("select", "", { id: "look-quantity" });
  Explore.data.quantities.forEach(({ title }, k) => select.append(Explore.element("option", title, { value: k })));
  select.value = Explore.quantity;
  select.addEventListener("change", () => {
    Explore.quantity = Number(select.value);
    Explore.showInternals(section, row, healthy);
    Explore.part("quantity").focus();
  });
  label.append(select);
  return label;
};
