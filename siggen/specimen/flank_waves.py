"""Flank waves of one specimen: what is drawn for its two gears, and its labels."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from siggen.config import Config
from siggen.gears.errors.error_shapes import Draws
from siggen.gears.errors.flank_waves import ORDERS, with_waves
from siggen.gears.errors.flank_waves import FlankWaves as DrawnWaves
from siggen.gears.geometry.face_shares import FaceShares
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.missing_material import MissingMaterial
from siggen.keys.distributions import LogUniform, Uniform
from siggen.seeding import Stage, named_generator

CLAMPING = (2, 3, 4)
"""Waves per revolution that the jaws of a chuck leave."""
GHOSTS = 3.0
"""Mean number per gear, Poisson (assumed; measured: 0 to 8 lines beside the mesh)."""
MOST_GHOSTS = 8
ORDER_OVER_TEETH = LogUniform(low=2.3, high=15.0)
"""Waves of a ghost per revolution over the number of teeth, made whole (measured: 7 to 16)."""
GHOST_UM = LogUniform(low=0.02, high=0.3)
"""Amplitude per ghost (source: ripple of some tenths)."""
LAG_OVER_FACE_RAD = Uniform(low=0.0, high=3.0)
"""By how much a ghost's phase differs between the ends of the face, which weakens it (assumed)."""
CLAMPING_UM = LogUniform(low=0.5, high=3.0)
"""Amplitude of each of the chuck's waves (orders: source; size assumed)."""
COMMON_UM = LogUniform(low=0.3, high=3.0)
"""Amplitude of one cycle over the flank in the form of all teeth (assumed, within class 5 to 7)."""
COMMON_EXPONENT = Uniform(low=1.0, high=2.2)
"""Cycle h of that form has h to minus this (measured: 6 to 13 dB per octave)."""
OWN_UM = LogUniform(low=0.1, high=1.0)
"""The amplitude of each tooth's own form (assumed: at four cycles the size of a ghost)."""
OWN_EXPONENT = Uniform(low=0.9, high=1.6)
"""Its fall (measured: sidebands pass mesh lines above mesh 5)."""
LEAST_LINE_LOAD_N_PER_M = 1e3
"""Where there is next to no torque: a Hertz band of some 10 µm."""
KEPT_POINTS = 8
"""Operating points whose waves are kept, each of some megabytes; states and repeats share them."""
REFERENCE_OVER_TEETH = 2.3
"""Waves over teeth at which a ghost has the amplitude that is drawn; more make it smaller in proportion (assumed)."""


@dataclass(frozen=True, slots=True)
class SpecimenWaves:
    """Waves of both gears; the first `ghosts` of each are ghosts, those behind them come from the chuck."""

    pinion: DrawnWaves
    gear: DrawnWaves
    ghosts: dict[str, int]


def specimen_waves(config: Config, pair: GearPair, specimen_id: int, state_id: int) -> SpecimenWaves | None:
    """Return the waves of a specimen in a state; None without them. Every draw has a name."""
    if config.manufacture is None or config.manufacture.flank_waves == "off":
        return None
    owner = (specimen_id, state_id if config.manufacture.draw == "state" else 0)

    def draws(name: str) -> np.random.Generator:
        return named_generator(config.seed, Stage.MANUFACTURE, *owner, name=f"manufacture.flank_waves.{name}")

    pinion, gear = (_drawn(pair.member(which).teeth, which, draws) for which in ("pinion", "gear"))
    counts = {which: drawn.waves.size - len(CLAMPING) for which, drawn in (("pinion", pinion), ("gear", gear))}
    return SpecimenWaves(pinion, gear, counts)


class WavyTeeth:
    """Missing material of teeth with waves, which the Hertz band of a record's own torque smooths."""

    def __init__(
        self,
        missing: MissingMaterial,
        pair: GearPair,
        waves: SpecimenWaves | None = None,
        shares: FaceShares | None = None,
    ) -> None:
        self._plain, self._pair, self._waves, self._shares = missing, pair, waves, shares
        # not over instances: what belongs to a gearbox ends with it
        self._with_waves = lru_cache(maxsize=KEPT_POINTS)(self._smoothed)

    def under(self, torque_nm: float) -> MissingMaterial:
        """Return the missing material in contact under a torque at the pinion."""
        return self._with_waves(abs(torque_nm))

    def _smoothed(self, torque_nm: float) -> MissingMaterial:
        if self._waves is None:
            return self._plain
        pair = self._pair
        load = max(torque_nm / pair.pinion.base_radius_m / pair.face_width_m, LEAST_LINE_LOAD_N_PER_M)
        return with_waves(self._plain, pair, self._waves.pinion, self._waves.gear, load, self._shares)


def wave_labels(waves: SpecimenWaves | None) -> dict[str, object]:
    """Return the orders of the ghosts, per turn of their shaft, and their amplitudes before the contact's width."""
    if waves is None:
        return {}
    labels: dict[str, object] = {}
    for which, drawn in (("pinion", waves.pinion), ("gear", waves.gear)):
        count = waves.ghosts[which]
        labels[f"ghost_orders_{which}"] = [int(n) for n in drawn.waves[:count]]
        labels[f"ghost_amplitudes_{which}_um"] = [1e6 * float(a) for a in drawn.amplitude_m[:count]]
    return labels


def _drawn(teeth: int, which: str, draws: Draws) -> DrawnWaves:
    def uniform(name: str) -> float:
        return float(draws(f"{which}.{name}").random())

    count = min(int(draws(f"{which}.ghosts").poisson(GHOSTS)), MOST_GHOSTS)
    ghosts = [f"ghost.{k}" for k in range(count)]
    orders = [round(teeth * ORDER_OVER_TEETH.at(uniform(f"{ghost}.order"))) for ghost in ghosts]
    sizes = [
        GHOST_UM.at(uniform(f"{ghost}.size"))
        * min(REFERENCE_OVER_TEETH * teeth / order, 1.0)
        * float(np.sinc(LAG_OVER_FACE_RAD.at(uniform(f"{ghost}.lag")) / (2.0 * np.pi)))
        for ghost, order in zip(ghosts, orders, strict=True)
    ]
    clamping = [CLAMPING_UM.at(uniform(f"clamping.{n}")) for n in CLAMPING]
    common = COMMON_UM.at(uniform("common")) * ORDERS ** -COMMON_EXPONENT.at(uniform("common.fall"))
    own = OWN_UM.at(uniform("own")) * ORDERS ** -OWN_EXPONENT.at(uniform("own.fall"))
    turn = 2.0j * np.pi
    return DrawnWaves(
        waves=np.array([*orders, *CLAMPING], dtype=float),
        amplitude_m=1e-6 * np.array([*sizes, *clamping]),
        phase_rad=2.0 * np.pi * np.array([uniform(f"{name}.phase") for name in (*ghosts, *map(str, CLAMPING))]),
        common_m=1e-6 * common * np.exp(turn * draws(f"{which}.common.phases").random(ORDERS.size)),
        own_m=1e-6 * own * np.exp(turn * draws(f"{which}.own.phases").random((teeth, ORDERS.size))),
    )
