"""What makes the content of a set: records, rows of damage, internal quantities; loaded when a set is made."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from siggen.columns.record import RecordFailure, SimulatedRecord
from siggen.dataset.simulated_rows import RowSimulation
from siggen.keys.column import Column

if TYPE_CHECKING:
    from siggen.gearbox.design import SetDesign
    from siggen.record.compilation import CompilationPart


def _nothing(design: SetDesign) -> Sequence[CompilationPart]:  # noqa: ARG001 - as every physics
    return ()


def _no_sizes(design: SetDesign, specimen_id: int) -> Mapping[str, Mapping[str, object]]:  # noqa: ARG001
    return {}


def _no_life(design: SetDesign, specimen_id: int) -> Mapping[str, Sequence[Mapping[str, object]]]:  # noqa: ARG001
    return {}


@dataclass(frozen=True, slots=True)
class Physics:
    """Functions of (design, record): pure, and importable by name, since workers receive them.

    Attributes
    ----------
    simulate
        (design, ids of one specimen's records) -> records or failures.
    damage_rows
        (design, ids of one specimen's records) -> rows of `damage/`.
    life_rows
        (design, specimen) -> rows of the tables of `life/`, by table.
    quantities
        design -> columns of `internals/`; asked only where a set stores some.
    to_compile
        design -> tasks that compile what its records need, side by side; none where that is compiled.
    damage_sizes
        (design, specimen) -> labels of the damage of every state, from its drawing alone.
    """

    simulate: Callable[[SetDesign, Sequence[int]], Iterable[SimulatedRecord | RecordFailure]]
    damage_rows: Callable[[SetDesign, Sequence[int]], Iterable[Mapping[str, object]]]
    quantities: Callable[[SetDesign], Sequence[Column]]
    to_compile: Callable[[SetDesign], Sequence[CompilationPart]] = _nothing
    life_rows: Callable[[SetDesign, int], Mapping[str, Sequence[Mapping[str, object]]]] = _no_life
    damage_sizes: Callable[[SetDesign, int], Mapping[str, Mapping[str, object]]] = _no_sizes

    def simulation(self, design: SetDesign, renewals: int = 0) -> RowSimulation:
        """Return what makes rows of a set, with its columns, those of `internals/` too where it stores some."""
        from siggen.sets.drawn import set_columns

        columns = set_columns(design, () if design.stored is None else self.quantities(design))
        renewing = {"renewals": renewals} if renewals else {}
        return RowSimulation(columns, partial(self.simulate, design, **renewing), renewals)


def physics() -> Physics:
    """Return the physics of this version; compiled code is imported here and not before."""
    from siggen.sets import drawn

    makers = (drawn.simulated, drawn.damage_rows, drawn.stored_quantities, drawn.to_compile)
    return Physics(*makers, drawn.life_rows, drawn.damage_sizes)
