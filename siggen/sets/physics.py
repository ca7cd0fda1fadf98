"""What makes the content of a set: records, rows of damage, internal quantities; loaded when a set is made."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from siggen.dataset.chunk import Simulate
from siggen.dataset.excerpt import DamageRows, LifeRows
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
        (config, record_id) -> rows of `damage/`.
    life_rows
        (config, specimen) -> rows of the tables of `life/`, by table.
    quantities
        config -> columns of `internals/`; asked only where a set stores some.
    to_compile
        config -> tasks that compile what its records need, side by side; none where that is compiled.
    damage_sizes
        (config, specimen) -> labels of the damage of every state, from its drawing alone.
    """

    simulate: Simulate
    damage_rows: DamageRows
    quantities: Callable[[Config], Sequence[Column]]
    to_compile: Callable[[Config], Sequence[CompilationPart]] = _nothing
    life_rows: LifeRows = _no_life
    damage_sizes: Callable[[Config, int], Mapping[str, Mapping[str, object]]] = _no_sizes

    def stored(self, config: Config) -> tuple[Column, ...]:
        """Return the columns of `internals/` of a set; none where it stores none."""
        return () if config.internals is None else tuple(self.quantities(config))


def physics() -> Physics:
    """Return the physics of this version; compiled code is imported here and not before."""
    from siggen.record.compilation import to_compile
    from siggen.record.damage_rows import damage_rows
    from siggen.record.damage_sizes import damage_sizes
    from siggen.record.internals import stored_quantities
    from siggen.record.life_rows import life_rows
    from siggen.record.simulation import simulate_specimen

    return Physics(simulate_specimen, damage_rows, stored_quantities, to_compile, life_rows, damage_sizes)
