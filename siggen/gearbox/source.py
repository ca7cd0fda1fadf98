"""ConfigSource: a configuration as its user wrote it, before anything of it is checked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from siggen.config import ParsedConfig, apply_overrides, config_file, extended_files, inherited, parse, placed
from siggen.config.gears import GearsSection
from siggen.errors import ConfigError, Problem
from siggen.keys.yaml_source import read_yaml


@dataclass(frozen=True, slots=True)
class ConfigSource:
    """A file or mapping with overrides.

    Attributes
    ----------
    raw : as written, without what it extends
    overrides : such as `gears.module_mm=3.5`
    name : for messages
    file : None for a mapping
    """

    raw: Mapping[str, Any]
    overrides: Sequence[str] = ()
    name: str = "configuration"
    file: Path | None = None

    @classmethod
    def of(cls, source: str | Path | Mapping[str, Any], overrides: Sequence[str]) -> ConfigSource:
        """Return what a mapping, a file or the name of a preset holds.

        Raises
        ------
        UsageError, ConfigError
            If there is no such file or preset, or it cannot be read.
        """
        if isinstance(source, Mapping):
            return cls(source, overrides)
        file = config_file(source)
        return cls(read_yaml(file), overrides, str(source), file)

    @property
    def folder(self) -> Path:
        """From which the paths of files count."""
        return Path() if self.file is None else self.file.parent

    def merged(self) -> dict[str, Any]:
        """Return all keys: those that it extends, its own and its overrides."""
        return apply_overrides(inherited(self.raw, self.folder, self.name), self.overrides)

    def emptied_pairs(self) -> Iterator[Problem]:
        """Yield the problem of an empty `gears.pairs` that its user wrote.

        A stored configuration states every key of `gears`, so an empty list there is the default and nobody's slip.
        """
        for raw in (self.raw, apply_overrides({}, self.overrides)):
            gears = raw.get("gears")
            stored = isinstance(gears, Mapping) and set(GearsSection.model_fields) <= set(gears)
            if isinstance(gears, Mapping) and gears.get("pairs") in ([], ()) and not stored:
                yield Problem("gears.pairs", "a list without a pair", "allowed: one pair at least, or null for none")

    def refusal(self, problems: Sequence[Problem]) -> ConfigError:
        """Return the error that names all problems, each with the line of the file or the override that it is of."""
        files = () if self.file is None else extended_files(self.file)
        name = self.name + (" with overrides" if self.overrides else "")
        return ConfigError(placed(problems, files, self.overrides), name)


def parsed(keys: Mapping[str, Any]) -> ParsedConfig:
    """Return the sections that keys stand for, and what is wrong with their form."""
    return parse(keys)


def preset(name: str) -> dict[str, Any]:
    """Return the keys of a shipped configuration."""
    return inherited({"extends": name})
