"""A usable configuration from a file or mapping: its form, its consistency and its physics, all problems at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from siggen.config import Config, apply_overrides, config_file, extended_files, inherited, parse, placed, read_yaml
from siggen.config.gears import GearsSection
from siggen.errors import ConfigError, Problem


def emptied_pairs(raw: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the problem of an empty `gears.pairs` that someone wrote.

    Parameters
    ----------
    raw : mapping
        As written, without what it extends. A stored configuration states every key of `gears`, so an empty list there
        is the default and nobody's slip.
    """
    gears = raw.get("gears")
    if (
        not isinstance(gears, Mapping)
        or gears.get("pairs") not in ([], ())
        or set(GearsSection.model_fields) <= set(gears)
    ):
        return
    yield Problem("gears.pairs", "a list without a pair", "allowed: one pair at least, or null for none")


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


def load_config(source: str | Path | Mapping[str, Any], overrides: Sequence[str] = ()) -> Config:
    """Return the configuration in a YAML file or mapping, with overrides such as `gears.module_mm=3.5` applied.

    Where there is no file of this path, the name of a preset such as `quickstart` stands for the one that siggen ships.

    Raises
    ------
    UsageError
        If there is no such file or preset, or it cannot be read.
    ConfigError
        If anything is wrong with the configuration; names every problem of form and physics at once, each with the line
        of the file or the override that its value comes from.
    """
    if isinstance(source, Mapping):
        raw, folder, read_from, file = source, Path(), "configuration", None
    else:
        file = config_file(source)
        raw, folder, read_from = read_yaml(file), file.parent, str(source)
    # They load the physics, which takes as long as all else: behind a file that is missing or no YAML.
    from siggen.checks.density_files import with_density_files
    from siggen.checks.mode_files import mode_problems, with_mode_file
    from siggen.checks.physical_problems import physical_problems
    from siggen.checks.response_files import response_problems, with_measured_responses
    from siggen.checks.state_problems import state_problems
    from siggen.gearbox.possible import PossibleGearbox
    from siggen.rig.sizes import with_sizes

    with_densities, unusable = with_density_files(apply_overrides(inherited(raw, folder, read_from), overrides), folder)
    filled, unread = with_measured_responses(with_densities, folder)
    with_modes, unread_modes = with_mode_file(filled, folder)
    sized, unsized = with_sizes(with_modes)
    parsed = parse(sized)
    written = [problem for own in (raw, apply_overrides({}, overrides)) for problem in emptied_pairs(own)]
    gearbox = PossibleGearbox.of_sections(parsed.sections)
    of_files = (*response_problems(gearbox), *mode_problems(gearbox))
    of_physics = [*physical_problems(gearbox), *([] if parsed.problems else state_problems(gearbox)), *of_files]
    told = [*written, *parsed.problems, *unread, *unread_modes, *unusable, *unsized]
    problems = [*told, *_beyond(told, map(parsed.names.problem, of_physics))]
    if parsed.config is not None and not problems:
        from siggen.checks.quantity_names import quantity_problems

        problems = quantity_problems(gearbox)
    if parsed.config is None or problems:
        files = () if file is None else extended_files(file)
        raise ConfigError(placed(problems, files, overrides), read_from + (" with overrides" if overrides else ""))
    return parsed.config
