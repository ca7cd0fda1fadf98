"""Where a sensor may stand in a gearbox: words of the casing, bearings, shafts and couplings that the model has.

The words of a further stage NAME are those of damage and labels: NAME.pinion and NAME.gear turn, and the shaft whose
speed is NAME_shaft_hz runs in NAME_bearing.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from siggen.errors import Problem
from siggen.keys.problems import nearest

PLATES = "casing, housing.kind: plates"
"""The model whose housing gives way."""
MODAL = "casing, housing.kind: modal"
"""The model whose housing gives way as given modes say."""
PLATE_OF = {"lid": "lid", "wall": "front", "pinion_end": "pinion_end", "gear_end": "gear_end", "foot": "floor"}
"""Place -> plate of the housing."""
GEARS = ("pinion", "gear")
BEARINGS = tuple(f"{gear}_bearing" for gear in GEARS)
ON_CASING = {"casing": ("casing",), PLATES: tuple(PLATE_OF), MODAL: ("casing", *PLATE_OF)}
"""Places on the housing of a model."""
OF_SET = ("ring", "sun_bearing", "carrier_bearing")
"""Places of a planetary set."""
STAGE = "[a-z][a-z0-9_]{0,39}"
"""Names of further stages."""


@dataclass(frozen=True, slots=True)
class PlaceText:
    """Words of `place` for readers of a file, and those with the NAME of a further stage; a gearbox has some."""

    words: tuple[str, ...]
    of_stages: tuple[str, ...]

    @property
    def allowed_text(self) -> str:
        """All words."""
        return f"one of {', '.join(self.words)}, of a further stage {', '.join(self.of_stages)}"

    def __get_pydantic_json_schema__(self, _: Any, __: Any) -> dict[str, Any]:
        """Return the words, or a pattern for those of stages."""
        endings = "|".join(re.escape(word.removeprefix("NAME")) for word in self.of_stages)
        return {"anyOf": [{"enum": list(self.words)}, {"type": "string", "pattern": f"^{STAGE}({endings})$"}]}


AT_BEARINGS = PlaceText(BEARINGS, ("NAME_bearing",))
IN_MOTION = PlaceText((*BEARINGS, *PLATE_OF, "casing", *OF_SET), ("NAME_bearing",))
TURNING = PlaceText(("motor", *GEARS, "load"), tuple(f"NAME.{gear}" for gear in GEARS))


@dataclass(frozen=True, slots=True)
class Places:
    """What there is in the gearboxes of a configuration.

    Attributes
    ----------
    model : `dynamics.model`, with its housing where that gives way
    stages : names of the further stages, in the order of power
    helical : whether teeth push along the shafts
    planetary : whether it is a planetary set
    """

    model: str
    stages: tuple[str, ...] = ()
    helical: bool = False
    planetary: bool = False

    @property
    def gears(self) -> tuple[str, ...]:
        """Every gear, as damage names it."""
        return (*GEARS, *(f"{stage}.{gear}" for stage in self.stages for gear in GEARS))

    @property
    def bearings(self) -> tuple[str, ...]:
        """The bearings of every shaft."""
        return () if self.planetary else (*BEARINGS, *(f"{stage}_bearing" for stage in self.stages))

    @property
    def pressed_along(self) -> tuple[str, ...]:
        """Bearings that hold a shaft along its axis against a force."""
        return self.bearings if self.helical else ()

    @property
    def pressed(self) -> tuple[str, ...]:
        """Bearing forces as place/axis, those along the shafts behind all others."""
        across = (f"{place}/{axis}" for place in self.bearings for axis in ("vertical", "horizontal"))
        return (*across, *(f"{place}/axial" for place in self.pressed_along))

    @property
    def moved_along(self) -> tuple[str, ...]:
        """Places that move along the shafts: on a housing that gives way, and shafts on the ground."""
        on_ground = self.pressed_along if self.model == "8dof" else ()
        return self.motions if self.model in {PLATES, MODAL} else on_ground

    @property
    def motions(self) -> tuple[str, ...]:
        """Places whose motion the model has."""
        if self.planetary:
            return (*ON_CASING.get(self.model, ()), *OF_SET)
        return (*ON_CASING.get(self.model, ()), *self.bearings)

    @property
    def shafts(self) -> tuple[str, ...]:
        """What turns and can carry a sensor."""
        return () if self.planetary else ("motor", *self.gears, "load")

    @property
    def ends_of_meshes(self) -> tuple[tuple[tuple[str, ...], tuple[str, ...]], ...]:
        """What turns as the driving and as the driven gear of each mesh do, but for a coupling in between."""
        driving, driven = self.gears[::2], self.gears[1::2]
        return tuple(
            ((a, "motor") if a == driving[0] else (a,), (b, "load") if b == driven[-1] else (b,))
            for a, b in zip(driving, driven, strict=True)
        )

    @property
    def couplings(self) -> tuple[str, ...]:
        """Couplings at both ends of the gearbox."""
        return () if self.planetary else ("input_coupling", "output_coupling")

    def problems(self, place: str, allowed: Sequence[str]) -> Iterator[Problem]:
        """Yield a place that is none of those that the gearbox has for a sensor."""
        if place not in allowed:
            named = f"one of {', '.join(allowed)}" if allowed else "none, so no sensor of this kind"
            yield Problem("place", f"'{place}'", f"allowed: {named} ({self._where}){nearest(place, allowed)}")

    @property
    def _where(self) -> str:
        stages = f", stages: {', '.join(self.stages)}" if self.stages else ""
        return f"dynamics.model: {self.model}{stages}{', planetary' if self.planetary else ''}"
