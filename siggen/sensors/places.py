"""Where a sensor may stand in a gearbox: words of the casing, bearings, gears and couplings that the model has.

A shaft SHAFT runs in SHAFT_bearing; gears bear their own names.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from siggen.errors import Problem
from siggen.keys.problems import nearest
from siggen.keys.user_name import PART
from siggen.names import PAIR, Names

PLATES = "casing, housing.kind: plates"
"""The model whose housing gives way."""
MODAL = "casing, housing.kind: modal"
"""The model whose housing gives way as given modes say."""
PLACE_TEXT = (
    "accelerometer: lid to foot need housing.kind: plates, casing the kinds rigid, modal or a path, NAME_bearing "
    "several meshes; encoder: what it turns with, a gear of any mesh; torque: motor to first gear, "
    "or last gear to load; force: whose bearings, of a machine SHAFT_bearing"
)
"""Meaning of the key `place` of every kind of sensor."""
PLATE_OF = {"lid": "lid", "wall": "front", "pinion_end": "pinion_end", "gear_end": "gear_end", "foot": "floor"}
"""Place -> plate of the housing."""
ON_CASING = {"casing": ("casing",), PLATES: tuple(PLATE_OF), MODAL: ("casing", *PLATE_OF)}
"""Places on the housing of a model."""
OF_SET = ("ring", "sun_bearing", "carrier_bearing")
"""Places of a planetary set."""


@dataclass(frozen=True, slots=True)
class PlaceText:
    """Words of `place` for readers of a file, and the form of those with a name of its own; a gearbox has some."""

    words: tuple[str, ...]
    named: str

    @property
    def allowed_text(self) -> str:
        """All words."""
        return f"one of {', '.join(self.words)}, with a machine {self.named}"

    def __get_pydantic_json_schema__(self, _: Any, __: Any) -> dict[str, Any]:
        """Return the words, or a pattern for those with a name."""
        ending = "_bearing" if self.named.endswith("_bearing") else ""
        return {"anyOf": [{"enum": list(self.words)}, {"type": "string", "pattern": f"^{PART}{ending}$"}]}


BEARINGS = tuple(shaft.bearing for shaft in PAIR.shafts)
AT_BEARINGS = PlaceText(BEARINGS, "SHAFT_bearing")
IN_MOTION = PlaceText((*BEARINGS, *PLATE_OF, "casing", *OF_SET), "SHAFT_bearing")
TURNING = PlaceText(("motor", *(gear.word for gear in PAIR.gears), "load"), "the name of a gear")


@dataclass(frozen=True, slots=True)
class Places:
    """What there is in the gearboxes of a configuration.

    Attributes
    ----------
    model : `dynamics.model`, with its housing where that gives way
    names : of gears and shafts
    helical : whether teeth push along the shafts
    planetary : whether it is a planetary set
    """

    model: str
    names: Names = PAIR
    helical: bool = False
    planetary: bool = False

    @property
    def gears(self) -> tuple[str, ...]:
        """Every gear; an idler is one."""
        return tuple(dict.fromkeys(gear.body for gear in self.names.gears))

    @property
    def bearings(self) -> tuple[str, ...]:
        """The bearings of every shaft."""
        return () if self.planetary else tuple(shaft.bearing for shaft in self.names.shafts)

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
        ends = [(mesh.driver.body, mesh.driven.body) for mesh in self.names.meshes]
        first, last = ends[0][0], ends[-1][1]
        return tuple(((a, "motor") if a == first else (a,), (b, "load") if b == last else (b,)) for a, b in ends)

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
        return f"dynamics.model: {self.model}{', planetary' if self.planetary else ''}"
