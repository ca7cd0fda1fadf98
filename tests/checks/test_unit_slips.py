"""A slip of units in any number key is refused or named: every one times 1e-3, 60 and 1e3."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
import yaml

from siggen.checks.loading import load_config
from siggen.checks.plausibility import implausible
from siggen.errors import ConfigError, UsageError
from siggen.gearbox.design import SetDesign
from siggen.keys.distributions import DRAWN
from siggen.keys.section import Section

SILENT = {
    ("duration_s", 60.0): "records of minutes are usual",
    ("dynamics.load_inertia_kg_m2", 1e-3): "nothing heavy is driven",
    ("dynamics.load_inertia_kg_m2", 60.0): "a mill or a flywheel turns behind its gears",
    ("dynamics.load_inertia_kg_m2", 1e3): "the same",
    ("dynamics.output_coupling.stiffness_nm_per_rad", 60.0): "a stiff coupling is built, too",
    ("dynamics.input_coupling.stiffness_nm_per_rad", 60.0): "the same",
    ("dynamics.motor_inertia_kg_m2", 60.0): "a motor of another machine",
    ("sensors.lid.range_m_s2", 1e-3): "a seismic accelerometer",
    ("sensors.side.range_m_s2", 1e-3): "the same",
    **{
        (f"states.{key}_mm", 60.0): "a pit of a gear that is as much larger"
        for key in (
            "layered.damage.semi_axis_profile",
            "clustered.damage.semi_axis_profile",
            "clustered.damage.spread_profile",
            "list.damage.pits.0.semi_axis_profile",
        )
    },
    ("states.list.damage.pits.0.face_mm", 1e-3): "a pit at the edge of the face",
}
"""Slips that nobody can see, and why."""
FACTORS = (1e-3, 60.0, 1e3)


def number_keys(section: Section, path: str = "") -> Iterator[str]:
    """Yield the path of every key that holds a number other than 0; that of one entry of a list."""
    for name in type(section).model_fields:
        value, here = getattr(section, name), f"{path}.{name}" if path else name
        if name == "changes":  # of keys that are tried by themselves
            continue
        if isinstance(value, (float, *DRAWN)) and value != 0.0:
            yield here
        elif isinstance(value, Section):
            yield from number_keys(value, here)
        elif isinstance(value, tuple):
            for place, item in enumerate(value):
                if isinstance(item, Section):
                    key = getattr(item, item.key_field) if item.key_field else place
                    yield from number_keys(item, f"{here}.{key}")


def written(config: SetDesign, path: str) -> Any:
    value = config.canonical()
    for key in path.split("."):
        value = value[int(key)] if isinstance(value, list) else value[key]
    return value


def times(value: Any, factor: float) -> Any:
    if isinstance(value, dict):
        return {key: times(item, factor) for key, item in value.items()}
    return [times(item, factor) for item in value] if isinstance(value, list) else value * factor


def silent_slips(preset: str, factors: tuple[float, ...]) -> tuple[int, list[tuple[str, float]]]:
    """Return how many slips were tried, and those that nothing is said of."""
    config = load_config(preset)
    before, keys = set(implausible(config.possible)), [*number_keys(config.config)]
    silent = []
    for key in keys:
        for factor in factors:
            slip = yaml.safe_dump(times(written(config, key), factor), default_flow_style=True, width=1000)
            change = f"{key}={slip.removesuffix(chr(10) + '...' + chr(10))}"
            try:
                if not set(implausible(load_config(preset, [change]).possible)) - before:
                    silent.append((key, factor))
            except (ConfigError, UsageError):
                continue
    return len(keys) * len(factors), silent


def test_a_slip_by_sixty_in_any_number_of_quickstart_is_seen() -> None:
    tried, silent = silent_slips("quickstart", (60.0,))
    assert set(silent) <= set(SILENT)
    assert len(silent) <= 0.05 * tried


@pytest.mark.slow
@pytest.mark.parametrize(
    "preset", ["quickstart", "two_stage", "planetary", "confusers", "fleet", "tests/golden_kinds.yaml"]
)
def test_any_slip_is_seen_or_has_its_reason(preset: str) -> None:
    tried, silent = silent_slips(preset, FACTORS)
    assert set(silent) <= set(SILENT)
    assert len(silent) <= 0.05 * tried
