"""A usable configuration from a file or mapping: its form, its consistency and its physics, all problems at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from siggen.errors import Problem
from siggen.gearbox.configured import ConfigSource, parsed

if TYPE_CHECKING:
    from siggen.gearbox.design import SetDesign


def _beyond(told: Sequence[Problem], of_physics: Iterable[Problem]) -> Iterator[Problem]:
    """Yield what physics finds at keys that nothing was said of, nor of their section; the same of a key once."""
    paths, found = {problem.path for problem in told}, list[Problem]()
    for problem in of_physics:
        parts = problem.path.split(".")
        sections = {".".join(parts[:end]) for end in range(1, len(parts))}
        again = any(
            one.path in sections or (one.path, one.received) == (problem.path, problem.received) for one in found
        )
        if paths.isdisjoint({*sections, problem.path}) and not again:
            found.append(problem)
            yield problem


def load_config(source: str | Path | Mapping[str, Any], overrides: Sequence[str] = ()) -> SetDesign:
    """Return the design of a set by a YAML file or mapping, with overrides such as `gears.module_mm=3.5`.

    Where there is no file of this path, the name of a preset such as `quickstart` stands for the one that siggen ships.

    Raises
    ------
    UsageError
        If there is no such file or preset, or it cannot be read.
    ConfigError
        If anything is wrong with the configuration; names every problem of form and physics at once, each with the line
        of the file or the override that its value comes from.
    """
    written = ConfigSource.of(source, overrides)
    # They load the physics, which takes as long as all else: behind a file that is missing or no YAML.
    from siggen.checks.number_files import (
        mode_problems,
        response_problems,
        with_density_files,
        with_measured_responses,
        with_mode_file,
    )
    from siggen.checks.physical_problems import physical_problems, state_problems
    from siggen.gearbox.design import SetDesign
    from siggen.gearbox.possible import PossibleGearbox
    from siggen.rig.sizes import with_sizes

    with_densities, unusable = with_density_files(written.merged(), written.folder)
    filled, unread = with_measured_responses(with_densities, written.folder)
    with_modes, unread_modes = with_mode_file(filled, written.folder)
    sized, unsized = with_sizes(with_modes)
    form = parsed(sized)
    gearbox = PossibleGearbox.of_sections(form.sections)
    of_files = (*response_problems(gearbox), *mode_problems(gearbox))
    of_physics = [*physical_problems(gearbox), *([] if form.problems else state_problems(gearbox)), *of_files]
    told = [*written.emptied_pairs(), *form.problems, *unread, *unread_modes, *unusable, *unsized]
    problems = [*told, *_beyond(told, map(form.names.problem, of_physics))]
    if form.config is not None and not problems:
        from siggen.record.quantity_names import quantity_problems

        problems = quantity_problems(gearbox)
    if form.config is None or problems:
        raise written.refusal(problems)
    return SetDesign(form.config)
