"""The configuration of one gearbox in one state: that of the gearbox, with the keys that the state changes.

Everything that follows the state reads it as if a user had written a file for this gearbox. So nothing behind it knows
of changes, and each number takes the uniform that it has in the healthy gearbox.
"""

from __future__ import annotations

from siggen.config import Config
from siggen.config.changes import changed_sections
from siggen.planning.gearbox import gearbox_config
from siggen.seeding import Stage, named_uniforms


def state_config(config: Config, specimen_id: int, state_id: int) -> Config:
    """Return the configuration of a gearbox in a state, itself its own; that of the gearbox where nothing changes.

    A change that is drawn belongs to gearbox and state; what a state keeps of a milder one keeps its draw.
    """
    own = gearbox_config(config, specimen_id)
    changes = own.changes_of(state_id)
    if not changes:
        return own
    drawn = [
        one.drawn(named_uniforms(own.seed, Stage.DAMAGE, specimen_id, origin), own.states[origin].name)
        for origin, one in changes
    ]
    sections = {name: getattr(own, name) for name in type(own).model_fields}
    # the converter is that of all states, whatever becomes of the noise: its step must not tell the state
    sections["sensors"] = tuple(one.model_copy(update={"bits": one.converter_bits}) for one in own.sensors)
    states = tuple(state.model_copy(update={"changes": ()}) for state in own.states)
    return own.model_copy(update={**changed_sections(sections, drawn), "states": states})
