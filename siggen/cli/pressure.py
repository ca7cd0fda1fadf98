"""`siggen inspect pressure`: load and pressure over one flank while its tooth goes through mesh in a record."""

from __future__ import annotations

from typing import TYPE_CHECKING

from siggen.cli.echo import echo
from siggen.cli.inspection import Inspection
from siggen.cli.working import working
from siggen.errors import UsageError

if TYPE_CHECKING:
    from siggen.gearbox.design import SetDesign
    from siggen.gearbox.plan import PlannedRecord


def pressure(asked: Inspection) -> None:
    """Simulate a record and write how the force of a tooth spreads over its flank: load per length and pressure.

    Force and tilt are those of the motion. How they spread is solved across the face, with damage, crowning, helix and
    misalignment, and with the elastic pressure at the edges of damage as round as they were drawn.
    """
    from siggen.views.pressure import (
        chosen_positions,
        face_pressure,
        largest_text,
        pressure_table,
        save_pressure_figure,
    )

    png = asked.png()
    gear, tooth = _tooth(asked.tooth)
    with working("simulating the record and solving the pressure across the face"):
        design = asked.design()
        found = face_pressure(design.gearbox(asked.gearbox), _record(design, asked), gear, tooth)
    table, said = pressure_table(found), largest_text(found)
    echo(f"{found.view.state}, {found.view.gear} tooth {found.view.tooth}: {said}", err=True)
    asked.hand_over(
        table,
        lambda file: save_pressure_figure(found, chosen_positions(found), file),
        png,
        lambda: {
            "state": found.view.state, "gear": found.view.gear, "tooth": found.view.tooth, "flank": table.to_pydict()
        },
    )  # fmt: skip


def _tooth(text: str | None) -> tuple[str | None, int | None]:
    """Return gear and index of `gear:4`, or an index alone."""
    if text is None:
        return None, None
    gear, _, index = text.rpartition(":")
    if not index.isdecimal():
        raise UsageError(f"--tooth {text}: allowed: an index such as 4, or a gear and an index such as gear:4")
    return gear or None, int(index)


def _record(design: SetDesign, asked: Inspection) -> PlannedRecord:
    """Return the first record of the gearbox in a state, by default in its last one."""
    from siggen.gearbox.plan import planned_record, record_ids_of
    from siggen.keys.problems import nearest

    ids, of_each = record_ids_of(design, asked.gearbox), design.points * design.repeats
    names = design.state_names[: len(ids) // of_each]
    state = names[-1] if asked.state is None else asked.state
    if state not in names:
        raise UsageError(f"--state: received '{state}'; allowed: {', '.join(names)}{nearest(state, names)}")
    return planned_record(design, ids[names.index(state) * of_each])
