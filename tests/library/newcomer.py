"""What somebody writes who has just installed siggen; a test runs it, and mypy checks its types."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

import siggen
from siggen import Crack, Gear, GearPair, Pit, State, mesh_stiffness, pits_in_layers

Array = npt.NDArray[np.float64]

# 1  three lines to a plotted record
gearbox = siggen.single_stage(teeth=(23, 61), module_mm=2.5)
record = siggen.run(gearbox, speed_hz=25, torque_nm=40)
record.plot()
record.spectrum().plot()

# 2  mesh stiffness of a pair with pits: where they lie
pair = GearPair.of(teeth=(18, 47), module_mm=3.5, face_width_mm=20)
for height_mm in (1.0, 1.9, 2.8, 4.6):
    pits = pits_in_layers("pinion", layers=1, pits_per_layer=16, first_height_mm=height_mm)
    mesh_stiffness(pair, pits, law="linear").plot(label=f"{height_mm} mm")

# 3  pits where they are wanted
mine = [Pit("pinion", height_mm=1.9, face_mm=z, semi_axes_mm=(0.4, 0.2), depth_mm=0.3) for z in np.linspace(2, 18, 9)]
siggen.flank_picture(pair, mine)

# 4  two stages with names of one's own; all states of one gearbox
hoist = siggen.machine(
    shafts={"input": {}, "middle": {"span_mm": 120}, "drum": {"mass_kg": 6}},
    gears={
        "a": {"teeth": 18, "shaft": "input"},
        "b": {"teeth": 47, "shaft": "middle"},
        "c": {"teeth": 17, "shaft": "middle"},
        "d": {"teeth": 52, "shaft": "drum"},
    },
    meshes={
        "fast": {"gears": ["a", "b"], "module_mm": 2},
        "slow": {"gears": ["c", "d"], "module_mm": 3, "direction_deg": 30},
    },
    rated_nm=60,
)
hoist = hoist.with_(
    State("c_pitted", tuple(Pit("c", face_mm=z) for z in (8.0, 10.0, 12.0))),
    State("d_cracked", (Crack("d", depth_mm=1.0),)),
)
siggen.run(hoist, "c_pitted", speed_hz=16, torque_nm=50, duration_s=0.07).plot("input_vertical")


# 5  a fault of one's own: one method
@dataclass(frozen=True)
class Dent(siggen.Damage):
    depth_um: float = 20.0

    def missing_m(self, gear: Gear, profile_m: Array, face_m: Array) -> Array:
        along, across = (profile_m - 2e-3) / 0.4e-3, (face_m - 0.5 * gear.face_width_m) / 1e-3
        return 1e-6 * self.depth_um * np.exp(-(along**2) - across**2)


dented = gearbox.with_(State("dented", (Dent("pinion"),)))
siggen.run(dented, "dented", speed_hz=25, torque_nm=40, duration_s=0.1)


# 6  a sensor of one's own: what it reads, and what it does to it
@dataclass(frozen=True)
class StrainGauge:
    name: str
    shaft: str

    def channels(self, gearbox: siggen.Gearbox) -> Sequence[siggen.Channel]:
        force = siggen.Reading(f"{self.shaft}.bearing", "vertical", order=0, weight=2.1e-9)
        return [siggen.Channel(f"{self.name}_strain", "1", (force,), lambda f: 1 / (1 + 1j * f / 5e3))]


strained = siggen.run(gearbox.with_(StrainGauge("seat", "input")), speed_hz=25, torque_nm=40, duration_s=0.1)
assert np.std(strained.channels["seat_strain"]) > 0.0

# 7  a gearbox of a set, in all its states
config = siggen.load_config("quickstart", ["duration_s=0.1"])
third = siggen.draw(config, 3)
levels = {one.name: np.std(siggen.run(third, one.name).channels["lid_vertical"]) for one in third.states}
print(*levels)
