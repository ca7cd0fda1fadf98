"""What is asked of a set by the numbers of its records and gearboxes, each gearbox drawn for it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from siggen.columns.record import RecordFailure, SetColumns, SimulatedRecord
from siggen.columns.record import set_columns as columns_of_gearbox
from siggen.errors import ConfigError, SolverFailure
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record, record_ids_of
from siggen.keys.column import Column
from siggen.record import damage_rows as rows
from siggen.record import damage_sizes as sizes
from siggen.record import life_rows as lives
from siggen.record.compilation import MOTION, SHORT_S, TEETH, CompilationPart, is_compiled
from siggen.record.quantities import quantity_column
from siggen.record.quantity_names import available_quantities, quantity_problems
from siggen.record.simulation import simulate_specimen
from siggen.record.specimen_state import refused_as
from siggen.record.stage_times import stage


def set_columns(design: SetDesign, quantities: Sequence[Column] = ()) -> SetColumns:
    """Return the columns of a set that stores some internal quantities, by its first gearbox that can be drawn."""
    return columns_of_gearbox(design.first(), design.identity, quantities)


def simulated(
    design: SetDesign, record_ids: Sequence[int], renewals: int = 0
) -> Iterator[SimulatedRecord | RecordFailure]:
    """Return records of one gearbox in their order, each simulated when it is asked for, and its renewals behind it.

    Raises
    ------
    ValueError
        At once if the records belong to more than one gearbox.
    """
    with stage("plan"):
        records = [planned_record(design, i) for i in record_ids]
    numbers = sorted({record.specimen_id for record in records})
    if len(numbers) != 1:
        raise ValueError(f"records of one specimen expected, received specimens {numbers}")
    try:
        with refused_as("outside_model"), stage("plan"):
            gearbox = design.gearbox(numbers[0])
    except SolverFailure as failure:
        each = [RecordFailure(record.record_id, failure.status, failure.reason) for record in records]
        return iter([one for one in each for _ in range(1 + renewals)])
    return simulate_specimen(gearbox, records, renewals)


def damage_rows(design: SetDesign, record_ids: Sequence[int]) -> Iterator[dict[str, object]]:
    """Return the rows of damage of records of one gearbox."""
    records = [planned_record(design, i) for i in record_ids]
    try:
        gearbox = design.gearbox(records[0].specimen_id)
    except ValueError:  # its records are told as failures
        return iter(())
    return rows.damage_rows(gearbox, records)


def life_rows(design: SetDesign, specimen_id: int) -> dict[str, list[lives.Row]]:
    """Return the rows of a gearbox that runs to failure, by table."""
    each = design.points * design.repeats
    return lives.life_rows(design.life(specimen_id), specimen_id, record_ids_of(design, specimen_id)[::each])


def damage_sizes(design: SetDesign, specimen_id: int) -> dict[str, Mapping[str, object]]:
    """Return the sizes of damage of the states of a gearbox; none of one that cannot be drawn."""
    try:
        return sizes.damage_sizes(design.gearbox(specimen_id))
    except ValueError:
        return {}


def stored_quantities(design: SetDesign) -> tuple[Column, ...]:
    """Return the columns of `internals/` that a set stores.

    Raises
    ------
    ConfigError
        If it names quantities that the model does not have.
    """
    if design.stored is None:
        return ()
    if problems := quantity_problems(design.possible):
        raise ConfigError(problems)
    asked = available_quantities(design.possible) if design.stores_all else design.stored
    return tuple(quantity_column(name, design.names) for name in dict.fromkeys(asked))


def to_compile(design: SetDesign) -> tuple[CompilationPart, ...]:
    """Return the parts, largest first; none where a record of such a configuration was compiled on this machine."""
    return () if is_compiled(design.method) else compilation_parts(design)


def compilation_parts(design: SetDesign) -> tuple[CompilationPart, ...]:
    """Return what compiles what records of a set need: damaged teeth, then all else with plain ones."""
    number = design.first().specimen_id
    return (
        CompilationPart(TEETH, partial(design.gearbox, number), design.damaged_states(number) or (0,)),
        CompilationPart(MOTION, partial(design.plain(SHORT_S).gearbox, number)),
    )
