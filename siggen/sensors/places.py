"""Where a sensor may stand in a gearbox: words of the casing, bearings, shafts and couplings that the model has.

The words of a further stage NAME are those of damage and labels: NAME.pinion and NAME.gear turn, and the shaft whose
speed is NAME_shaft_hz runs in NAME_bearing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from siggen.errors import Problem
from siggen.keys.problems import nearest

PLATES = "casing, housing.kind: plates"
"""The model whose housing gives way."""
MODAL = "casing, housing.kind: modal"
"""The model whose housing gives way as given modes say."""
PLANETARY = "8dof, planetary"
"""The model of a planetary set."""
PLATE_OF = {"lid": "lid", "wall": "front", "pinion_end": "pinion_end", "gear_end": "gear_end", "foot": "floor"}
"""Place -> plate of the housing."""
GEARS = ("pinion", "gear")
BEARINGS = tuple(f"{gear}_bearing" for gear in GEARS)
RIMS = tuple(f"{gear}_rim" for gear in GEARS)
ON_CASING = {"casing": ("casing",), PLATES: tuple(PLATE_OF), MODAL: ("casing", *PLATE_OF)}
"""Places on the housing of a model."""
OF_SET = ("ring", "sun_bearing", "carrier_bearing")
"""Places of a planetary set."""
BEARING_WORDS = "pinion_bearing, gear_bearing, or NAME_bearing: the shaft of NAME.gear of a further stage"


@dataclass(frozen=True, slots=True)
class Places:
    """What there is in the gearboxes of a configuration.

    Attributes
    ----------
    model : `dynamics.model`, with its housing where that gives way
    stages : names of the further stages, in the order of power
    """

    model: str
    stages: tuple[str, ...] = ()

    @property
    def gears(self) -> tuple[str, ...]:
        """Every gear, as damage names it."""
        return (*GEARS, *(f"{stage}.{gear}" for stage in self.stages for gear in GEARS))

    @property
    def bearings(self) -> tuple[str, ...]:
        """The bearings of every shaft."""
        return (
            ()
            if self.model in {"torsional", PLANETARY}
            else (*BEARINGS, *(f"{stage}_bearing" for stage in self.stages))
        )

    @property
    def motions(self) -> tuple[str, ...]:
        """Places whose motion the model has."""
        if self.model == PLANETARY:
            return OF_SET
        return RIMS if self.model == "torsional" else (*ON_CASING.get(self.model, ()), *self.bearings)

    @property
    def shafts(self) -> tuple[str, ...]:
        """What turns and can carry a sensor."""
        if self.model == PLANETARY:
            return ()
        return self.gears if self.model == "6dof" else ("motor", *self.gears, "load")

    @property
    def couplings(self) -> tuple[str, ...]:
        """Couplings at both ends of the gearbox."""
        return () if self.model in {"6dof", PLANETARY} else ("input_coupling", "output_coupling")

    def problems(self, place: str, allowed: Sequence[str]) -> Iterator[Problem]:
        """Yield a place that is none of those that the gearbox has for a sensor."""
        if place not in allowed:
            named = f"one of {', '.join(allowed)}" if allowed else "none, so no sensor of this kind"
            yield Problem("place", f"'{place}'", f"allowed: {named} ({self._where}){nearest(place, allowed)}")

    @property
    def _where(self) -> str:
        stages = f", stages: {', '.join(self.stages)}" if self.stages else ""
        return f"dynamics.model: {self.model}{stages}"
