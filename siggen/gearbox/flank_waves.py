"""Flank waves of a mesh as they are drawn: ghosts of the cutting machine, the chuck, forms of teeth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.gears.errors import Draws
from siggen.gears.flank_waves import ORDERS
from siggen.gears.flank_waves import FlankWaves as DrawnWaves
from siggen.gears.gear_pair import GearPair
from siggen.keys.distributions import LogUniform, Uniform
from siggen.names import Side
from siggen.seeding import Stream, named_generator

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
REFERENCE_OVER_TEETH = 2.3
"""Waves over teeth at which a ghost has the amplitude that is drawn; more make it smaller in proportion (assumed)."""


@dataclass(frozen=True, slots=True)
class SpecimenWaves:
    """Waves of both gears; the first `ghosts` of each are ghosts, those behind them come from the chuck."""

    pinion: DrawnWaves
    gear: DrawnWaves
    ghosts: dict[Side, int]


def drawn_waves(seed: int, owner: tuple[int, int], pair: GearPair) -> SpecimenWaves:
    """Return the waves of a mesh whose draws have this seed and owner, gearbox and state; every draw has a name."""

    def draws(name: str) -> np.random.Generator:
        return named_generator(seed, Stream.MANUFACTURE, *owner, name=f"manufacture.flank_waves.{name}")

    pinion, gear = (_drawn(pair.member(side).teeth, side, draws) for side in Side)
    counts = {side: drawn.waves.size - len(CLAMPING) for side, drawn in zip(Side, (pinion, gear), strict=True)}
    return SpecimenWaves(pinion, gear, counts)


def _drawn(teeth: int, side: Side, draws: Draws) -> DrawnWaves:
    def uniform(name: str) -> float:
        return float(draws(f"{side}.{name}").random())

    count = min(int(draws(f"{side}.ghosts").poisson(GHOSTS)), MOST_GHOSTS)
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
        common_m=1e-6 * common * np.exp(turn * draws(f"{side}.common.phases").random(ORDERS.size)),
        own_m=1e-6 * own * np.exp(turn * draws(f"{side}.own.phases").random((teeth, ORDERS.size))),
    )
