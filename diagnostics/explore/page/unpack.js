"use strict";
// Reads what the page carries: packed arrays, and the place of a sample in revolutions.
const Explore = {};

Explore.data = JSON.parse(document.getElementById("data").textContent);

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

// What a channel holds: its word and unit.
Explore.held = (channel) => Explore.data.held[channel];

Explore.view = (row, channel) => {
  const signals = Explore.data.signals[row];
  return { missing: signals.missing, pulses: Explore.floats(signals.pulses), ...signals.channels[channel] };
};

Explore.element = (tag, text, attributes = {}) => {
  const made = document.createElement(tag);
  if (text) made.textContent = text;
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
};

Explore.number = (value) => (value === null || !Number.isFinite(value) ? "undefined" : Number(value.toPrecision(4)).toString());
