"""What contradicts a section `life`: states beside it, gearboxes with further meshes, torque that no flank wears by."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from siggen.config.life import Life
from siggen.config.short_form import stages_of
from siggen.errors import Problem
from siggen.keys.number import bounds, number_text


def life_problems(sections: Mapping[str, Any], raw: Mapping[str, object]) -> Iterator[Problem]:
    """Yield states beside a life, and what else it cannot be beside."""
    life: Life | None = sections.get("life")
    if life is None:
        return
    if raw.get("states"):
        yield Problem("states", "states beside a section life", "allowed: one of both; with life states: null")
    for beside, what in (
        (stages_of(sections["machine"]), "further meshes"),
        (sections.get("planetary"), "planets"),
    ):
        if beside:
            yield Problem("life", f"a section life with {what}", f"allowed: null, or no {what}: teeth of one pair wear")
    yield from _loads(sections, life)


def _loads(sections: Mapping[str, Any], life: Life) -> Iterator[Problem]:
    """Yield loads under which no tooth ever pits, or the back flanks would."""
    if life.history and not any(min(block) > 0.0 for block in life.history):
        received = "no block with torque and speed above 0"
        yield Problem("life.history", received, "allowed: one at least, or teeth never fail")
    points = sections.get("operating_points", ())
    if life.follows_point and points and bounds(points[0].torque_nm)[0] <= 0.0:
        received = f"{number_text(points[0].torque_nm)} with a section life"
        allowed = "allowed: above 0, the torque between inspections, by which the front flanks wear"
        yield Problem("operating_points.0.torque_nm", received, allowed)
