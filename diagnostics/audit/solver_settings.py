"""Trap: solver settings that a state carries in the configuration."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet

SETTINGS = frozenset(
    {
        *(
            "integrator",
            "solver",
            "steps_per_sample",
            "time_step_s",
            "tolerance",
            "table_points",
            "stiffness",
            "dynamics",
        ),
        *("mesh_damping_ratio", "fs_hz", "duration_s", "sensors", "operating_points", "noise", "seed"),
    }
)
"""Keys of the numerics and of the recording; where a state has its own, it can be told by them."""


def solver_settings(measured: MeasuredSet) -> list[Finding]:
    """Return a finding if states of the configuration differ in settings that are not their damage."""
    states = [state for state in measured.config.get("states", []) if isinstance(state, Mapping)]
    own = [_settings(state) for state in states]
    if len(own) < 2 or all(settings == own[0] for settings in own):
        return []
    differing = sorted({key for settings in own for key in settings if any(s.get(key) != settings[key] for s in own)})
    return [
        Finding(
            "solver_settings_by_state",
            f"states differ in {', '.join(differing)}",
            "states may differ in their damage only",
            "Move these keys out of the states.",
        )
    ]


def _settings(section: Mapping[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in section.items():
        if key in SETTINGS:
            found[key] = value
        elif isinstance(value, Mapping):
            found |= {f"{key}.{name}": inner for name, inner in _settings(value).items()}
    return found
