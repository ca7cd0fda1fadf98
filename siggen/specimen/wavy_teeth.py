"""WavyTeeth: teeth whose flank waves a record's own torque smooths."""

from __future__ import annotations

from functools import lru_cache

from siggen.gearbox.flank_waves import SpecimenWaves
from siggen.gears.errors.flank_waves import with_waves
from siggen.gears.geometry.face_shares import FaceShares
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.missing_material import MissingMaterial

LEAST_LINE_LOAD_N_PER_M = 1e3
"""Where there is next to no torque: a Hertz band of some 10 µm."""
KEPT_POINTS = 8
"""Operating points whose waves are kept, each of some megabytes; states and repeats share them."""


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
