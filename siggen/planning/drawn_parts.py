"""Parts that a gearbox draws by name: the damaged gear, how many of its teeth, and the oil."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any

from siggen.config import Config, StateSection
from siggen.config.oil import oils_of
from siggen.faults.fault import Fault
from siggen.keys.distributions import Choice
from siggen.keys.teeth import drawn_teeth, most_teeth
from siggen.seeding import Stage, named_uniforms


def with_drawn_parts(config: Config, specimen_id: int) -> Config:
    """Return a configuration in which one gearbox's damaged gear, number of teeth and oil are given."""
    if not has_drawn_parts(config):
        return config
    teeth = named_uniforms(config.seed, Stage.DAMAGED_TEETH, specimen_id)
    oils = oils_of(config.dynamics.friction.oil)
    supports = named_uniforms(config.seed, Stage.SUPPORTS, specimen_id)
    oil = oils[int(supports("dynamics.friction.oil") * len(oils))]
    return _with_oil(_with_damage(config, _drawn_hit(teeth)), oil)


def has_drawn_parts(config: Config) -> bool:
    """Tell whether gearboxes differ in what `with_drawn_parts` gives."""
    return isinstance(config.dynamics.friction.oil, tuple) or any(
        _gear(one) == "either" or isinstance(getattr(one, "teeth", None), Choice)
        for state in config.states
        for one in state.damages
    )


def possible_states(states: Mapping[str, StateSection]) -> Iterator[dict[str, StateSection]]:
    """Yield the states with each gear that may be damaged, at most of its teeth: what checks look at."""
    either = any(_gear(one) == "either" for state in states.values() for one in state.damages)
    for gear in ("pinion", "gear") if either else ("pinion",):
        hit = partial(_most_hit, gear)
        yield {index: _state_hit(state, hit) for index, state in states.items()}


Hit = Callable[[Any], dict[str, object]]
"""Damage of a state -> its gear and teeth."""


def _drawn_hit(uniform: Callable[[str], float]) -> Hit:
    gear, u = ("pinion", "gear")[int(2.0 * uniform("gear"))], uniform("teeth")
    return lambda damage: _hit(damage, gear, drawn_teeth(damage.teeth, u))


def _most_hit(gear: str, damage: Any) -> dict[str, object]:
    return _hit(damage, gear, most_teeth(damage.teeth))


def _hit(damage: Any, gear: str, teeth: int | tuple[int, ...]) -> dict[str, object]:
    return {"gear": gear if damage.gear == "either" else damage.gear, "teeth": teeth}


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
