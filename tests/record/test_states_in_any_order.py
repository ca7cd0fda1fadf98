"""What the states of a gearbox share is reused to the bit: tables and labels of a state, whatever was made before."""

from __future__ import annotations

import numpy as np

from siggen.checks.loading import load_config
from siggen.damage import flank_damage
from siggen.gearbox.configured import gearbox_config
from siggen.gearbox.design import SetDesign
from siggen.mesh import contact_table
from siggen.mesh import tooth_compliance as compliance
from siggen.record import contact
from siggen.record.specimen_state import StateTeeth, state_teeth
from siggen.record.teeth import MeshTeeth, all_teeth

SHARED = (
    contact._healthy_tables,
    contact_table._healthy,
    flank_damage._rows_of,
    compliance._pit_pieces,
)
CONFIG = gearbox_config(load_config("configs/bench.yaml", ["specimens=20"]).config, 3)
SPECIMEN = SetDesign(CONFIG).gearbox(3)
NAMES = [state.name for state in CONFIG.states]


def teeth_of(made: MeshTeeth, name: str) -> StateTeeth:
    state_id = NAMES.index(name)
    return state_teeth(SPECIMEN, made, state_id)


def numbers(teeth: StateTeeth) -> list[bytes]:
    tables, solved = teeth.tables.tables, teeth.tables.contact
    assert solved is not None
    arrays = (*solved, tables.pair_stiffness_n_per_m, tables.contributions_n_per_m, tables.row_of_pair)
    return [np.asarray(array).tobytes() for array in arrays]


def test_teeth_of_a_state_are_the_same_to_the_bit_whatever_states_were_made_before() -> None:
    """A chain of grown dishes, backwards and with others before it, against the state alone without anything kept."""
    made = all_teeth(SPECIMEN)[0]
    order = ("face_40", "slight", "healthy", "face_20", "through_020")
    after_others = {name: teeth_of(made, name) for name in order}
    for name in ("face_20", "face_40"):
        for kept in SHARED:
            kept.cache_clear()
        alone = teeth_of(all_teeth(SetDesign(CONFIG).gearbox(3))[0], name)
        assert alone.labels["mesh_stiffness_loss"] != 0.0
        assert alone.damage == after_others[name].damage
        assert alone.labels == after_others[name].labels
        assert numbers(alone) == numbers(after_others[name])
