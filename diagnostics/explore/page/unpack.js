"use strict";
// Reads what the page carries: packed arrays, columns, and the place of a sample in revolutions.
const Explore = {};

Explore.data = JSON.parse(document.getElementById("look-data").textContent);
Explore.part = (name) => document.getElementById(`look-${name}`);

Explore.bytes = (text) => {
  const raw = atob(text);
  const found = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k++) found[k] = raw.charCodeAt(k);
  return found.buffer;
};

Explore.values = (packed) =>
  Array.from(new Int16Array(Explore.bytes(packed.data)), (count) => (count === -32768 ? null : count * packed.step));

Explore.floats = (text) => new Float32Array(Explore.bytes(text));

Explore.samples = (wave) => {
  const buffer = Explore.bytes(wave.sample.data);
  const steps = wave.sample.bits === 16 ? new Uint16Array(buffer) : new Uint32Array(buffer);
  const [first, end] = wave.fine;
  const found = [];
  let at = 0;
  let filled = false;
  const fill = () => {
    for (let k = first; k < end; k++) found.push(k);
    filled = true;
  };
  for (const step of steps) {
    at += step;
    if (!filled && at >= end) fill();
    found.push(at);
  }
  if (!filled) fill();
  return found;
};

// Revolutions since the first pulse; the speed of the first and the last revolution beyond them.
Explore.revolutions = (samples, pulses) => {
  const last = pulses.length - 2;
  let turn = 0;
  return samples.map((sample) => {
    const time = sample / Explore.data.fs_hz;
    while (turn < last && time >= pulses[turn + 1]) turn++;
    return turn + (time - pulses[turn]) / (pulses[turn + 1] - pulses[turn]);
  });
};

// A column of labels: numbers (null where there is none), or texts from a list of names.
Explore.unpackLabel = ({ kind, names, data }) => {
  if (kind === "text") return Array.from(new Uint16Array(Explore.bytes(data)), (code) => (code ? names[code - 1] : null));
  if (kind === "whole") return Array.from(new Int32Array(Explore.bytes(data)));
  const floats = kind === "short" ? new Float32Array(Uint32Array.from(new Uint16Array(Explore.bytes(data)), (upper) => upper << 16).buffer) : Explore.floats(data);
  return Array.from(floats, (value) => (Number.isFinite(value) ? value : null));
};

// Everything that records can be chosen and drawn by: labels, then indicators; values are unpacked when they are wanted.
Explore.columns = [
  ...Explore.data.labels.map((label) => ({ ...label, group: "labels", indicator: null })),
  ...Explore.data.indicators.map((one) => ({
    name: one.name, title: one.channel ? `${one.title} (${one.channel})` : one.title, kind: one.kind, data: one.data,
    group: one.channel ? `indicators of ${one.channel}` : "your indicators", indicator: one,
  })),
];
Explore.columnOf = new Map(Explore.columns.map((column) => [column.name, column]));
Explore.columnValues = (column) => (column.values ??= Explore.unpackLabel(column));
Explore.firstIndicator = Explore.data.labels.length;

// Labels that the page itself needs of a record, as one object each.
Explore.records = (() => {
  const needed = Explore.data.needed.map((name) => [name, Explore.columnValues(Explore.columnOf.get(name))]);
  return Array.from({ length: Explore.data.count }, (_, k) => Object.fromEntries(needed.map(([name, values]) => [name, values[k]])));
})();

Explore.rowOf = new Map(Explore.records.map((record, row) => [record.record_id, row]));
Explore.rowsOver = (data) => (data === null ? null : Array.from(new Int32Array(Explore.bytes(data)), (row) => (row < 0 ? null : row)));
Explore.overlay = Explore.rowsOver(Explore.data.overlay);
Explore.beside = Explore.rowsOver(Explore.data.beside);

// Signals, spectra, averages and damage of a record.
Explore.details = new Map();
Explore.detail = (row) => (row === null ? null : Explore.details.get(row) ?? null);

Explore.load = (row) => {
  if (row === null || Explore.details.has(row)) return;
  const found = Explore.held(`look-record-${row}`);
  if (found) Explore.details.set(row, found);
};

// What an element of the page holds; null where there is none.
Explore.held = (name) => {
  const here = document.getElementById(name);
  return here ? JSON.parse(here.textContent) : null;
};

// What a channel holds: its word and unit.
Explore.quantityOf = (channel) => Explore.data.held[channel];

Explore.view = (row, channel) => {
  const detail = Explore.detail(row);
  return { missing: detail.missing, pulses: Explore.floats(detail.pulses), ...detail.channels[channel] };
};

Explore.element = (tag, text, attributes = {}) => {
  const made = document.createElement(tag);
  if (text) made.textContent = text;
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
};

Explore.number = (value) => (value === null || value === undefined || !Number.isFinite(value) ? "undefined" : Number(value.toPrecision(4)).toString());
