// One chart of uPlot with what every chart here has: colours of the page, marks, zoom by mouse, buttons and keys.
Explore.colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

Explore.plots = new Map(); // host element -> plot

// Draws vertical lines at marks(first, last) -> [{at, text, colour, to}], below the curves.
Explore.markHook = (marks) => (plot) => {
  const { ctx, bbox } = plot;
  const scale = plot.scales.x;
  if (scale.min == null) return;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textAlign = "left";
  ctx.textBaseline = "alphabetic";
  let free = -Infinity; // where the last text ends, so that none lies over another
  const wanted = marks(scale.min, scale.max).sort((a, b) => a.at - b.at || (a.to === undefined) - (b.to === undefined));
  for (const mark of wanted) {
    const x = plot.valToPos(mark.at, "x", true);
    ctx.fillStyle = ctx.strokeStyle = Explore.colour(mark.colour || "mark");
    if (mark.to !== undefined) {
      ctx.globalAlpha = 0.18;
      ctx.fillRect(x, bbox.top, Math.max(plot.valToPos(mark.to, "x", true) - x, 2), bbox.height);
    }
    ctx.globalAlpha = mark.faint ? 0.3 : 0.75;
    ctx.beginPath();
    ctx.setLineDash(mark.faint ? [] : [4 * devicePixelRatio, 3 * devicePixelRatio]);
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.globalAlpha = 1;
    if (!mark.text) continue;
    const gap = 3 * devicePixelRatio;
    const width = ctx.measureText(mark.text).width;
    const from = Math.min(x + gap, bbox.left + bbox.width - width);
    if (x < bbox.left || from < free) continue;
    ctx.fillText(mark.text, from, bbox.top + 11 * devicePixelRatio);
    free = from + width + gap;
  }
  ctx.restore();
};

Explore.zoom = (plot, factor, shift) => {
  const { min, max } = plot.scales.x;
  const x = plot.data[0];
  const [first, last] = plot.whole || [x[0], x[x.length - 1]];
  const width = Math.min((max - min) * factor, last - first);
  const low = Math.min(Math.max((min + max) / 2 + shift * (max - min) - width / 2, first), last - width);
  plot.setScale("x", { min: low, max: low + width });
};

Explore.reset = (plot) => {
  const x = plot.data[0];
  const [min, max] = plot.whole || [x[0], x[x.length - 1]];
  plot.setScale("x", { min, max });
};

Explore.ACTIONS = [
  ["−", "zoom out", "-", (plot) => Explore.zoom(plot, 2, 0)],
  ["+", "zoom in", "+", (plot) => Explore.zoom(plot, 0.5, 0)],
  ["←", "to the left", "ArrowLeft", (plot) => Explore.zoom(plot, 1, -0.25)],
  ["→", "to the right", "ArrowRight", (plot) => Explore.zoom(plot, 1, 0.25)],
  ["all", "see all", "0", Explore.reset],
];

Explore.tools = (title, plot) => {
  const tools = Explore.element("div", "", { class: "tools", role: "group", "aria-label": `Zoom: ${title}` });
  tools.append(Explore.element("strong", title, { "aria-hidden": "true" }));
  for (const [sign, label, , act] of Explore.ACTIONS) {
    const button = Explore.element("button", sign, { type: "button", "aria-label": `${label}: ${title}` });
    button.addEventListener("click", () => act(plot()));
    tools.append(button);
  }
  return tools;
};

// A name that is longer than its axis would be cut at both ends: its beginning says more.
Explore.fitted = (name, side) => ({ bbox, ctx }) => {
  const [middle, whole] = side ? [bbox.top + bbox.height / 2, ctx.canvas.height] : [bbox.left + bbox.width / 2, ctx.canvas.width];
  const room = 2 * Math.min(middle, whole - middle);
  let text = name;
  while (text.length > 4 && ctx.measureText(text).width > room) text = `${text.slice(0, -2)}…`;
  return text;
};

Explore.axis = (label, side, more = {}) => ({
  label: label && Explore.fitted(label, side), stroke: Explore.colour("ink"), grid: { stroke: Explore.colour("grid"), width: 1 },
  ticks: { stroke: Explore.colour("grid") }, size: side ? 62 : 38, labelSize: 20,
  values: (_, splits) => splits.map((value) => (value === null ? "" : Number(value.toPrecision(6)).toString())),
  ...more,
});

Explore.line = (label, colour, more = {}) => ({
  label, stroke: Explore.colour(colour), width: 1, spanGaps: true, points: { show: false },
  value: (_, value) => (value == null ? "–" : Explore.number(value)), ...more,
});

// what: {title, caption, x, y, series, data, marks, range, group, height, start, short, cursor, summary, hooks, xAxis, yAxis, scaleY, bare}
Explore.chart = (host, what) => {
  const figure = Explore.element("figure");
  const area = Explore.element("div", "", { class: "plot", tabindex: "0", role: "img", "aria-label": `${what.title}. ${what.summary || ""} Keys plus, minus, arrows and 0 zoom.` });
  let plot = null;
  figure.append(Explore.tools(what.title, () => plot), area, Explore.element("figcaption", what.caption));
  host.append(figure);
  const followers = () => [...Explore.plots.values()].filter((other) => other !== plot && what.group && other.group === what.group);
  const options = {
    width: Math.max(area.clientWidth, 200), height: what.height || 240,
    scales: { x: { time: false }, y: what.scaleY || {} },
    axes: [Explore.axis(what.x, false, what.xAxis), Explore.axis(what.y, true, what.yAxis)],
    legend: { show: !what.bare },
    series: [{ label: what.short || what.x, value: (_, value) => (value == null ? "–" : Explore.number(value)) }, ...what.series],
    cursor: { drag: { x: true, y: false }, focus: { prox: 16 }, ...(what.group ? { sync: { key: what.group, setSeries: false } } : {}), ...what.cursor },
    hooks: {
      drawClear: what.marks ? [Explore.markHook(what.marks)] : [],
      setScale: [(own, key) => {
        if (key !== "x" || Explore.linking || !what.group || own.gone) return; // a destroyed plot may still have a scale to set
        Explore.linking = true;
        for (const other of followers()) other.setScale("x", { min: own.scales.x.min, max: own.scales.x.max });
        Explore.linking = false;
      }],
      ...what.hooks,
    },
  };
  plot = new uPlot(options, what.data, area);
  plot.group = what.group;
  plot.whole = what.range;
  Explore.plots.set(area, plot);
  if (what.range) Explore.reset(plot);
  if (what.start) plot.setScale("x", what.start);
  area.addEventListener("keydown", (event) => {
    const found = Explore.ACTIONS.find(([, , key]) => key === event.key || (key === "+" && event.key === "="));
    if (!found || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    found[3](plot);
  });
  return plot;
};

Explore.clear = (host) => {
  for (const [area, plot] of Explore.plots) {
    if (!host.contains(area)) continue;
    plot.gone = true;
    plot.destroy();
    Explore.plots.delete(area);
  }
  host.replaceChildren();
};

Explore.resize = () => {
  for (const [area, plot] of Explore.plots) {
    const width = Math.max(area.clientWidth, 200);
    if (width !== plot.width) plot.setSize({ width, height: plot.height });
  }
};
