// The gearbox of a record over its life, in sets that run to failure.
Explore.showLife = (section, row) => {
  const found = (Explore.data.lives || {})[String(Explore.data.records[row].specimen_id)];
  const body = section.querySelector(".body");
  section.hidden = !found;
  body.replaceChildren();
  if (!found) return;
  const figure = Explore.element("figure");
  figure.append(Explore.element("img", "", { src: `data:image/png;base64,${found.png}`, alt: found.caption, class: "drawn" }), Explore.element("figcaption", found.caption));
  body.append(figure);
};
