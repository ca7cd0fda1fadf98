"""What is asked of a set by the numbers of its records and gearboxes, each gearbox drawn for it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from siggen.checks.quantity_names import available_quantities, quantity_problems
from siggen.columns.record import RecordFailure, SetColumns, SimulatedRecord
from siggen.columns.record import set_columns as columns_of_gearbox
from siggen.config import Config
from siggen.errors import ConfigError, SolverFailure
from siggen.gearbox.configured import gearbox_config, gearbox_life
from siggen.gearbox.draw import draw_specimen
from siggen.gearbox.possible import PossibleGearbox
from siggen.gearbox.specimen import Specimen
from siggen.keys.column import Column
from siggen.planning.plan import planned_record, record_ids_of
from siggen.record import damage_rows as rows
from siggen.record import damage_sizes as sizes
from siggen.record import life_rows as lives
from siggen.record.compilation import MOTION, SHORT_S, TEETH, CompilationPart, is_compiled
from siggen.record.quantities import quantity_column
from siggen.record.simulation import simulate_specimen
from siggen.record.specimen_state import refused_as
from siggen.record.stage_times import stage


def set_columns(config: Config, quantities: Sequence[Column] = ()) -> SetColumns:
    """Return the columns of a set that stores some internal quantities, by its first gearbox that can be drawn."""
    return columns_of_gearbox(first_drawn(config), config.identity, quantities)


TRIED = 100


def first_drawn(config: Config) -> Specimen:
    """Return the first gearbox of a set whose draw is not refused, as a ring that fits no planets is.

    Raises
    ------
    ValueError
        If all of the first hundred are refused.
    """
    numbers = range(min(TRIED, config.specimens))
    for number in numbers:
        try:
            return draw_specimen(config, number)
        except ValueError:
            if number == numbers[-1]:
                raise
    raise AssertionError("a set has gearboxes")


def simulated(config: Config, record_ids: Sequence[int]) -> Iterator[SimulatedRecord | RecordFailure]:
    """Return records of one gearbox in their order, each simulated when it is asked for.

    Raises
    ------
    ValueError
        At once if the records belong to more than one gearbox.
    """
    with stage("plan"):
        records = [planned_record(config, i) for i in record_ids]
    numbers = sorted({record.specimen_id for record in records})
    if len(numbers) != 1:
        raise ValueError(f"records of one specimen expected, received specimens {numbers}")
    try:
        with refused_as("outside_model"), stage("plan"):
            gearbox = draw_specimen(config, numbers[0])
    except SolverFailure as failure:
        return iter([RecordFailure(record.record_id, failure.status, failure.reason) for record in records])
    return simulate_specimen(gearbox, records)


def damage_rows(config: Config, record_ids: Sequence[int]) -> Iterator[dict[str, object]]:
    """Return the rows of damage of records of one gearbox."""
    records = [planned_record(config, i) for i in record_ids]
    try:
        gearbox = draw_specimen(config, records[0].specimen_id)
    except ValueError:  # its records are told as failures
        return iter(())
    return rows.damage_rows(gearbox, records)


def life_rows(config: Config, specimen_id: int) -> dict[str, list[lives.Row]]:
    """Return the rows of a gearbox that runs to failure, by table."""
    each = len(config.operating_points) * config.repeats
    return lives.life_rows(gearbox_life(config, specimen_id), specimen_id, record_ids_of(config, specimen_id)[::each])


def damage_sizes(config: Config, specimen_id: int) -> dict[str, Mapping[str, object]]:
    """Return the sizes of damage of the states of a gearbox; none of one that cannot be drawn."""
    try:
        return sizes.damage_sizes(draw_specimen(config, specimen_id))
    except ValueError:
        return {}


def stored_quantities(config: Config) -> tuple[Column, ...]:
    """Return the columns of `internals/` that a configuration asks for; none without the section `internals`.

    Raises
    ------
    ConfigError
        If the section names quantities that the model does not have.
    """
    if config.internals is None:
        return ()
    gearbox = PossibleGearbox(config)
    if problems := quantity_problems(gearbox):
        raise ConfigError(problems)
    asked = available_quantities(gearbox) if config.internals.stores_all else config.internals.quantities
    return tuple(quantity_column(name, config.names) for name in dict.fromkeys(asked))


def to_compile(config: Config) -> tuple[CompilationPart, ...]:
    """Return the parts, largest first; none where a record of such a configuration was compiled on this machine."""
    return () if is_compiled(config.dynamics.method) else compilation_parts(config)


def compilation_parts(config: Config) -> tuple[CompilationPart, ...]:
    """Return what compiles what records of a set need: damaged teeth, then all else with plain ones."""
    # the last state of every kind of damage, shams removing nothing
    number = first_drawn(config).specimen_id
    states = gearbox_config(config, number).states
    kinds = {type(one): i for i, state in enumerate(states) if not state.sham for one in state.damages}
    plain = tuple(state.model_copy(update={"damage": None}) for state in config.states[:1])
    parallel = config.dynamics.model_copy(update={"shafts": None})
    short = config.model_copy(update={"dynamics": parallel, "states": plain, "duration_s": SHORT_S})
    return (
        CompilationPart(TEETH, partial(draw_specimen, config, number), tuple(kinds.values()) or (0,)),
        CompilationPart(MOTION, partial(draw_specimen, short, number)),
    )
