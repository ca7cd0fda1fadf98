"""What makes the content of a set: records, rows of damage, internal quantities; loaded when a set is made."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from siggen.columns.record import RecordFailure, SimulatedRecord
from siggen.dataset.chunk import ChunkSimulation
from siggen.keys.column import Column

if TYPE_CHECKING:
    from siggen.config import Config
    from siggen.record.compilation import CompilationPart


def _nothing(config: Config) -> Sequence[CompilationPart]:  # noqa: ARG001 - as every physics
    return ()


def _no_sizes(config: Config, specimen_id: int) -> Mapping[str, Mapping[str, object]]:  # noqa: ARG001
    return {}


def _no_life(config: Config, specimen_id: int) -> Mapping[str, Sequence[Mapping[str, object]]]:  # noqa: ARG001
    return {}


@dataclass(frozen=True, slots=True)
class Physics:
    """Functions of (configuration, record): pure, and importable by name, since workers receive them.

    Attributes
    ----------
    simulate
        (config, ids of one specimen's records) -> records or failures.
    damage_rows
        (config, ids of one specimen's records) -> rows of `damage/`.
    life_rows
        (config, specimen) -> rows of the tables of `life/`, by table.
    quantities
        config -> columns of `internals/`; asked only where a set stores some.
    to_compile
        config -> tasks that compile what its records need, side by side; none where that is compiled.
    damage_sizes
        (config, specimen) -> labels of the damage of every state, from its drawing alone.
    """

    simulate: Callable[[Config, Sequence[int]], Iterable[SimulatedRecord | RecordFailure]]
    damage_rows: Callable[[Config, Sequence[int]], Iterable[Mapping[str, object]]]
    quantities: Callable[[Config], Sequence[Column]]
    to_compile: Callable[[Config], Sequence[CompilationPart]] = _nothing
    life_rows: Callable[[Config, int], Mapping[str, Sequence[Mapping[str, object]]]] = _no_life
    damage_sizes: Callable[[Config, int], Mapping[str, Mapping[str, object]]] = _no_sizes

    def simulation(self, config: Config) -> ChunkSimulation:
        """Return what makes rows of a set, with its columns, those of `internals/` too where it stores some."""
        from siggen.sets.drawn import set_columns

        columns = set_columns(config, () if config.internals is None else self.quantities(config))
        return ChunkSimulation(columns, partial(self.simulate, config))


def physics() -> Physics:
    """Return the physics of this version; compiled code is imported here and not before."""
    from siggen.sets import drawn

    makers = (drawn.simulated, drawn.damage_rows, drawn.stored_quantities, drawn.to_compile)
    return Physics(*makers, drawn.life_rows, drawn.damage_sizes)
