"""The drawn sections of a gearbox's drivetrain: of a pair or a planetary set, or those that its machine stands for."""

from __future__ import annotations

from siggen.config import Config, Dynamics, GearsSection
from siggen.config.machine import Stage, drivetrain, with_idlers
from siggen.keys.drawing import draw
from siggen.seeding import Stream, named_uniforms


def drawn_gears(config: Config, specimen_id: int) -> tuple[GearsSection, tuple[Stage, ...], dict[str, object]]:
    """Return the first pair of a gearbox by its own configuration, its further meshes, and rotors of a machine.

    Numbers of a machine belong to their shafts, gears and meshes by name, wherever these stand in the order of power.
    """
    gears = named_uniforms(config.seed, Stream.GEARS, specimen_id)
    if config.machine is None:
        return draw(config.gears, gears, "gears"), (), {}
    first, stages, rotors = drivetrain(draw(config.machine, gears, "machine"))
    return first, tuple(with_idlers(first, stages)), dict(rotors)


def drawn_dynamics(config: Config, specimen_id: int, rotors: dict[str, object]) -> Dynamics:
    """Return the section `dynamics` with the rotors of a machine."""
    section = draw(config.dynamics, named_uniforms(config.seed, Stream.SUPPORTS, specimen_id), "dynamics")
    return section.model_copy(update=rotors)
