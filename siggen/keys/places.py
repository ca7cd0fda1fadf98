"""Fields that place damage on a flank and give its lengths, shared by all kinds of damage."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from siggen.keys.number import Number, Within

GearName: TypeAlias = Literal["pinion", "gear"]
AnyGear: TypeAlias = Literal["pinion", "gear", "either"]
"""`either`: drawn per gearbox, the same for all of its states."""

DAMAGED_GEAR = "damaged gear; either: drawn per gearbox, one gear in all states"

HeightReading: TypeAlias = Literal["axial", "radial", "arc"]

Length = Annotated[Number, Within(above=0)]
Height = Annotated[Number | Literal["pitch"], Within(least=0, words=("pitch",))]
PlaceOnFace = Annotated[Number | None, Within(least=0, words=(None,))]

READING = "how heights above the base circle are measured: along the tooth's axis, along the radius, along the flank"
