// Damaged flanks of a record, to scale.
Explore.svg = (tag, attributes, text) => {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  if (text) made.textContent = text;
  return made;
};

Explore.MOST_FLANKS = 12;

Explore.flank = (gear, tooth, damages) => {
  const size = damages[0].flank;
  const margin = 0.6;
  const width = size.face_mm + 2 * margin;
  const height = size.tip_mm + 2 * margin;
  const depth = Math.max(...damages.map((damage) => damage.depth_mm));
  const text = `${gear} tooth ${tooth}: ${damages.length} ${damages.length === 1 ? damages[0].kind : "damages"}, up to ${Explore.number(depth)} mm deep`;
  const figure = Explore.element("figure");
  const drawing = Explore.svg("svg", { viewBox: `${-margin} ${-margin} ${width} ${height}`, width: Math.round(width * 16), height: Math.round(height * 16), role: "img", "aria-label": text });
  const up = (value) => size.tip_mm - value;
  const line = (at, more) => Explore.svg("line", { x1: 0, x2: size.face_mm, y1: up(at), y2: up(at), stroke: Explore.colour("mark"), "stroke-width": 0.05, ...more });
  drawing.append(Explore.svg("rect", { x: 0, y: 0, width: size.face_mm, height: size.tip_mm, fill: Explore.colour("paper"), stroke: Explore.colour("ink"), "stroke-width": 0.08 }));
  for (const damage of damages) {
    const points = damage.corners.map(([face, high]) => `${face},${up(high)}`).join(" ");
    const shape = Explore.svg("polygon", { points, fill: Explore.colour("damage"), "fill-opacity": 0.35 + (0.5 * damage.depth_mm) / (depth || 1), stroke: Explore.colour("damage"), "stroke-width": 0.04 });
    shape.append(Explore.svg("title", {}, `${damage.kind}, ${Explore.number(damage.depth_mm)} mm deep`));
    drawing.append(shape);
  }
  drawing.append(line(size.pitch_mm, { "stroke-dasharray": "0.4 0.25" }));
  figure.append(drawing, Explore.element("figcaption", text));
  return figure;
};

Explore.showFlank = (section, row) => {
  const body = section.querySelector(".body");
  body.replaceChildren();
  section.hidden = Explore.data.measured;
  const record = Explore.records[row];
  const { damage: damages } = Explore.detail(row);
  const teeth = Explore.damagedTeeth(row).filter(([gear]) => gear !== "none");
  if (!teeth.length) {
    const why = Explore.isRecording(row) ? "A recording does not tell its damage." : record.fault === "healthy" ? "This record is healthy." : "The table of damage names no gear for this record.";
    return void body.append(Explore.element("p", why));
  }
  const flanks = Explore.element("div", "", { class: "flanks" });
  for (const [gear, tooth] of teeth.slice(0, Explore.MOST_FLANKS)) {
    flanks.append(Explore.flank(gear, tooth, damages.filter((damage) => damage.gear === gear && damage.tooth === tooth)));
  }
  const size = damages.find((damage) => damage.gear === teeth[0][0]).flank;
  const more = teeth.length > Explore.MOST_FLANKS ? ` ${Explore.MOST_FLANKS} of ${teeth.length} flanks are drawn.` : "";
  body.append(flanks, Explore.element("p", `Face ${Explore.number(size.face_mm)} mm wide, from the base circle (below) to the tip (above); dashed: pitch circle. The stronger the colour, the deeper.${more}`));
};
