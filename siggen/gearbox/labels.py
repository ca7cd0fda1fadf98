"""Labels that follow from the drawing of a gearbox alone, each with its column: where gearboxes or states differ."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

import pyarrow as pa

from siggen.config import Config
from siggen.gearbox.configured import drawn_bearings, pair_of
from siggen.gears.gear_pair import GearPair
from siggen.keys.column import MICROMETRE, MILLIMETRE, Column, Role, in_role, list_of
from siggen.keys.number import constant
from siggen.sensors.sensor import SensorBase

Labels: TypeAlias = Mapping[Column, object]
SHAM = Column("sham", pa.bool_(), "", "whether its damage was drawn, but nothing removed", Role.TARGET)
CHANGED = Column(
    "changed_keys",
    list_of(pa.string()),
    "",
    "keys that differ from the healthy gearbox, besides damage",
    Role.TARGET,
)
PRIMARY = Column(
    "primary_fault",
    pa.string(),
    "",
    "fault, and of a combined state what its first damage in the list is called",
    Role.TARGET,
)
PAIR = in_role(
    Role.CONDITION,
    Column("pair", pa.int32(), "", "index of the gear pair in `gears.pairs` of config.yaml"),
    Column("module_mm", pa.float64(), MILLIMETRE, "normal module"),
    Column("face_width_mm", pa.float64(), MILLIMETRE, "width of the teeth in contact"),
    Column("centre_distance_mm", pa.float64(), MILLIMETRE, "working centre distance"),
    Column("contact_ratio", pa.float64(), "", "transverse contact ratio of the unloaded pair"),
    section="gears",
)
OIL = Column("oil", pa.string(), "", "oil of the gearbox", Role.CONDITION, "dynamics")
BEARING = Column("", pa.string(), "", "", Role.CONDITION, "dynamics")
CLEARANCE = Column("", pa.float64(), MICROMETRE, "", Role.CONDITION, "dynamics")
PLACE = Column("", pa.float64(), MILLIMETRE, "", Role.CONDITION, "sensors")


def state_labels(config: Config, state_id: int) -> Labels:
    """Return what a state is beside its fault, as far as states of its set need it."""
    states, labels = config.states, dict[Column, object]()
    state = states[state_id]
    if any(one.sham for one in states):
        labels[SHAM] = state.sham
    if any(one.changes for one in states):
        labels[CHANGED] = [change.path for _, change in config.changes_of(state_id)]
    words = {word for number in range(len(states)) for word in _words(config, number)}
    if words and any(len(one.damages) > 1 for one in states):
        labels[PRIMARY], shown = state.primary_fault, set(_words(config, state_id))
        for word in sorted(words):
            column = Column(f"has_{word}", pa.bool_(), "", f"whether it shows {word}", Role.TARGET)
            labels[column] = word in shown
    return labels


def _words(config: Config, state_id: int | None) -> Iterator[str]:
    """Yield the words of what a state and its milder states damage."""
    while state_id is not None:
        state = config.states[state_id]
        yield from (one.word for one in state.damages if state.damaged)
        state_id = config.grown_from(state_id)


def gearbox_labels(config: Config, specimen_id: int, pair: GearPair, oil: str, sensors: Sequence[SensorBase]) -> Labels:
    """Return what a gearbox of a set draws as a whole: pair, oil, bearings, places of sensors; nothing all share."""
    labels = dict[Column, object]()
    if (index := pair_of(config, specimen_id)) is not None:
        ratio = (pair.contact_end_m - pair.contact_start_m) / pair.base_pitch_m
        lengths_m = pair.pinion.module_m, pair.face_width_m, pair.working_centre_distance_m
        labels |= dict(zip(PAIR, (index, *(1e3 * length for length in lengths_m), ratio), strict=True))
    if isinstance(config.dynamics.friction.oil, tuple):
        labels[OIL] = oil
    for side, (bearing, clearance_um) in drawn_bearings(config, specimen_id).items():
        word = config.names.first.gear(side).word
        meaning = f"both bearings of the shaft of {word}, by their name in catalogues"
        labels[replace(BEARING, name=f"bearing_{word}", meaning=meaning)] = bearing.designation
        meaning = "radial play in running; below 0: preload; 0 of rollers"
        play_um = 0.0 if bearing.rollers else clearance_um
        labels[replace(CLEARANCE, name=f"bearing_clearance_{word}_um", meaning=meaning)] = play_um
    for law, sensor in zip(config.sensors, sensors, strict=True):
        for axis, number in enumerate(law.place_on_casing_mm):
            if config.gears.pairs or not isinstance(number, float):
                words = f"{('first', 'second')[axis]} distance of the sensor {sensor.name} from where its place counts"
                column = replace(PLACE, name=f"position_{'xy'[axis]}_{sensor.name}_mm", meaning=words)
                labels[column] = constant(sensor.place_on_casing_mm[axis])
    return labels
