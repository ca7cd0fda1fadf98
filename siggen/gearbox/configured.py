"""The configuration of one gearbox, and of one of its states, as if a user had written a file for it alone.

What is drawn as a whole (pair, damaged gear, its teeth, oil) stands in its place, and so do the keys that a state
changes. So nothing behind it knows of sets with many pairs or of changes, and each number takes the uniform that it has
in the healthy gearbox.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from siggen.config import (
    Config,
    ParsedConfig,
    StateSection,
    apply_overrides,
    config_file,
    extended_files,
    inherited,
    parse,
    placed,
)
from siggen.config.changes import changed_sections, drawn_changes
from siggen.config.dynamics import oils_of
from siggen.config.gears import GearsSection
from siggen.damage.fault import Fault
from siggen.errors import ConfigError, Problem
from siggen.gearbox.life import Lived, lived, lived_states
from siggen.keys.distributions import Choice
from siggen.keys.drawing import draw
from siggen.keys.number import at
from siggen.keys.teeth import drawn_teeth, most_teeth
from siggen.keys.yaml_source import read_yaml
from siggen.names import EITHER, Names, Side
from siggen.rig.bearings import BearingSize
from siggen.rig.carried_over import carried_over
from siggen.rig.sizes import SIZING, bearings_of, is_sized, sized
from siggen.seeding import Stream, generator, named_uniforms


def gearbox_config(config: Config, specimen_id: int) -> Config:
    """Return the configuration of one gearbox; depends on configuration and index alone, and is itself its own."""
    return _drawn(config, specimen_id) if config.life is None else _inspected(config, specimen_id)


def _drawn(config: Config, specimen_id: int) -> Config:
    index = pair_of(config, specimen_id)
    return with_drawn_parts(config if index is None else pair_config(config, index), specimen_id)


def _inspected(config: Config, specimen_id: int) -> Config:
    """Return the configuration of a gearbox whose inspections are states, as if a user had listed all outlines."""
    assert config.life is not None
    states = lived_states(config.life, gearbox_life(config, specimen_id), config.names)
    return _drawn(config, specimen_id).model_copy(update={"life": None, "states": states})


@lru_cache(maxsize=1024)
def gearbox_life(config: Config, specimen_id: int) -> Lived:
    """Return the life of a gearbox of a set with a section `life`."""
    return lived(_drawn(config, specimen_id), config.gears, specimen_id)


def inspection_count(config: Config, specimen_id: int) -> int:
    """Return how many states a gearbox has: all, or with `life` as many inspections as it lives to see."""
    return config.state_count if config.life is None else len(gearbox_life(config, specimen_id).ages_h)


def pair_config(config: Config, index: int) -> Config:
    """Return the configuration of the gearboxes with one of the pairs of `gears.pairs`."""
    sections: dict[str, Any] = {name: getattr(config, name) for name in type(config).model_fields}
    return config.model_copy(update=carried_over(sections, config.gears.pairs[index]))


def pair_configs(config: Config) -> Iterator[Config]:
    """Yield the configuration of each pair of a set; the configuration itself where it has one pair."""
    if not config.gears.pairs:
        yield config
    yield from (pair_config(config, index) for index in range(len(config.gears.pairs)))


def pair_of(config: Config, specimen_id: int) -> int | None:
    """Return the index in `gears.pairs` of a gearbox's pair, or None without pairs.

    Every pair occurs once in every block of as many gearboxes, in an order that is drawn for the block.
    """
    count = len(config.gears.pairs)
    if not count:
        return None
    block, place = divmod(specimen_id, count)
    return _order(config.seed, count, block)[place]


@lru_cache(maxsize=256)
def _order(seed: int, count: int, block: int) -> tuple[int, ...]:
    return tuple(generator(seed, Stream.PAIR_ORDER, block).permutation(count).tolist())


def with_drawn_parts(config: Config, specimen_id: int) -> Config:
    """Return a configuration in which one gearbox's damaged gear, number of teeth, oil and sizes are given."""
    if not has_drawn_parts(config):
        return with_drawn_sizes(config, specimen_id)
    teeth = named_uniforms(config.seed, Stream.DAMAGED_TEETH, specimen_id)
    oils = oils_of(config.dynamics.friction.oil)
    supports = named_uniforms(config.seed, Stream.SUPPORTS, specimen_id)
    oil = oils[int(supports("dynamics.friction.oil") * len(oils))]
    found = _with_oil(_with_damage(config, _drawn_hit(teeth, config.names)), oil)
    return with_drawn_sizes(found, specimen_id)


def with_drawn_sizes(config: Config, specimen_id: int) -> Config:
    """Return a configuration with the sizes of one gearbox that follow from its rated torque."""
    dynamics = config.dynamics
    if is_sized(dynamics):
        return config
    gears = draw(config.gears, named_uniforms(config.seed, Stream.GEARS, specimen_id), "gears")
    supports = named_uniforms(config.seed, Stream.SUPPORTS, specimen_id)
    return config.model_copy(update={"dynamics": sized(dynamics, gears, supports)})


def drawn_bearings(config: Config, specimen_id: int) -> dict[Side, tuple[BearingSize, float]]:
    """Return the bearings that a gearbox draws from the catalogue, and their clearance [um]; none where given."""
    index = pair_of(config, specimen_id)
    own = config if index is None else pair_config(config, index)
    gears = draw(own.gears, named_uniforms(own.seed, Stream.GEARS, specimen_id), "gears")
    supports = named_uniforms(own.seed, Stream.SUPPORTS, specimen_id)
    found = bearings_of(own.dynamics, gears, supports)
    return {
        side: (one, at(SIZING.clearance_um, supports(f"dynamics.{side}.bearing.geometry.clearance_um")))
        for side, one in zip(Side, found, strict=True)
        if one is not None
    }


def has_drawn_parts(config: Config) -> bool:
    """Tell whether gearboxes differ in damage or oil that `with_drawn_parts` gives."""
    return isinstance(config.dynamics.friction.oil, tuple) or any(
        config.names.flanks.get(one.hit_gear, ("", ""))[1] == EITHER or isinstance(getattr(one, "teeth", None), Choice)
        for state in config.states
        for one in state.damages
    )


def possible_damages(damage: Fault) -> Iterator[Fault]:
    """Yield damage on each gear that may have it, at most of its teeth: what checks look at."""
    gear: str | None = getattr(damage, "gear", None)
    if gear is None:
        yield damage
        return
    for hit in Side if gear == EITHER else (gear,):
        yield damage.model_copy(update={"gear": hit, "teeth": most_teeth(getattr(damage, "teeth"))})  # noqa: B009


Hit = Callable[[Any], dict[str, object]]
"""Damage of a state -> its gear and teeth."""


def _drawn_hit(uniform: Callable[[str], float], names: Names) -> Hit:
    role, u = tuple(Side)[int(2.0 * uniform("gear"))], uniform("teeth")
    drawn = {word: names.mesh(mesh).gear(role).word for word, (mesh, of) in names.flanks.items() if of == EITHER}
    return lambda damage: {"gear": drawn.get(damage.gear, damage.gear), "teeth": drawn_teeth(damage.teeth, u)}


def _gear(damage: Fault) -> str | None:
    return getattr(damage, "gear", None)


def _with_damage(config: Config, hit: Hit) -> Config:
    return config.model_copy(update={"states": tuple(_state_hit(state, hit) for state in config.states)})


def _state_hit(state: StateSection, hit: Hit) -> StateSection:
    hits = (one if _gear(one) is None else one.model_copy(update=hit(one)) for one in state.damages)
    return state.with_damages(tuple(hits))


def _with_oil(config: Config, oil: str) -> Config:
    friction = config.dynamics.friction.model_copy(update={"oil": oil})
    return config.model_copy(update={"dynamics": config.dynamics.model_copy(update={"friction": friction})})


def state_config(config: Config, specimen_id: int, state_id: int) -> Config:
    """Return the configuration of a gearbox in a state, itself its own; that of the gearbox where nothing changes.

    A change that is drawn belongs to gearbox and state; what a state keeps of a milder one keeps its draw.
    """
    own = gearbox_config(config, specimen_id)
    changes = own.changes_of(state_id)
    if not changes:
        return own
    sections = {name: getattr(own, name) for name in type(own).model_fields}
    of_states = {
        origin: (named_uniforms(own.seed, Stream.DAMAGE, specimen_id, origin), own.states[origin].name)
        for origin, _ in changes
    }
    drawn = drawn_changes(sections, [(one, *of_states[origin]) for origin, one in changes])
    # the converter is that of all states, whatever becomes of the noise: its step must not tell the state
    sections["sensors"] = tuple(one.model_copy(update={"bits": one.converter_bits}) for one in own.sensors)
    states = tuple(state.model_copy(update={"changes": ()}) for state in own.states)
    return own.model_copy(update={**changed_sections(sections, drawn), "states": states})


# ConfigSource: a configuration as its user wrote it, before anything of it is checked.


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
