"""No key that a state may change adds or takes a column, but where that is refused by its name."""

from __future__ import annotations

from pydantic_core import PydanticCustomError

import siggen
from siggen.checks.physical_problems import _columns
from siggen.config import Config
from siggen.config.changes import Change, _paths, changed_sections
from siggen.keys.distributions import Uniform
from siggen.sets.drawn import set_columns

OVERRIDES = (
    "manufacture={accuracy_class: 6}",
    "background={rubbing: {bursts: {}}, bearings: {}, machines: {}, shafts: {}, second_stage: {order: 7}}",
    "sensors.lid.mounting={frequency_hz: 8000, damping_ratio: 0.05}",
    "variation={}",
    # Sized bearings have columns; a state that changes the stiffness of one is refused, as one that replaces it.
    "dynamics.pinion.bearing.stiffness_n_per_m=2e8",
    "dynamics.gear.bearing.stiffness_n_per_m=2e8",
)
SOME = Uniform(low=0.3, high=0.4)


def test_columns_follow_from_the_healthy_gearbox_alone() -> None:
    config = siggen.load_config("industrial", list(OVERRIDES))
    sections = {name: getattr(config.config, name) for name in Config.model_fields}
    first = config.sensors[0].name
    paths = [*_paths(sections), *(f"sensors.{first}.{key}" for key in ("gain", "range_m_s2", "mounting.frequency_hz"))]
    tried, told = 0, set()
    for path in paths:
        for value in (0.35, SOME):
            try:
                changed = changed_sections(sections, [Change(path=path, value=value)])
            except PydanticCustomError:
                continue
            tried += 1
            other = config.with_sections(**changed)
            if set_columns(other).labels != set_columns(config).labels:
                before, after = (_columns(one.possible) for one in (config, other))
                told |= {name for name, present in before.items() if present != after[name]}
                assert after != before, path
    assert tried > 80
    assert told == {"variation", "manufacture.crowning_um"}
