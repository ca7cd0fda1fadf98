// The gearbox of a record over its life, in sets that run to failure.
Explore.lives = new Map();

Explore.showLife = (section, row) => {
  const unit = Explore.records[row].specimen_id;
  const body = section.querySelector(".body");
  section.hidden = !Explore.data.lives;
  if (!Explore.data.lives) return;
  if (!Explore.lives.has(unit)) Explore.lives.set(unit, Explore.held(`look-life-${unit}`));
  const found = Explore.lives.get(unit);
  body.replaceChildren();
  if (!found) return void body.append(Explore.element("p", "This page does not hold this gearbox over its life."));
  const figure = Explore.element("figure");
  figure.append(Explore.element("img", "", { src: `data:image/png;base64,${found.png}`, alt: found.caption, class: "drawn" }), Explore.element("figcaption", found.caption));
  body.append(figure);
};
