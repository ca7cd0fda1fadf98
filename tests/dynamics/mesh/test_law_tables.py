"""What a reader of an exported pair law gets is what the law was made of."""

from __future__ import annotations

import numpy as np

from siggen.dynamics.friction.asperity_table import AsperityTable
from siggen.dynamics.friction.friction import FrictionLaw
from siggen.dynamics.mesh.damping import DampingLaw
from siggen.dynamics.mesh.law_tables import law_tables
from siggen.dynamics.mesh.pair_law import MeshConstants, pair_law
from siggen.gears.contact.contact_table import ContactTable
from siggen.gears.geometry.missing_material import MissingMaterial, ToothTables
from siggen.gears.stiffness.mesh_tables import MeshTables
from tests.dynamics.mesh.test_coupled_pairs import table as coupling_table
from tests.dynamics.pair_runs import RELIEF, gear_pair, law, tables

ROWS, POINTS = 3, 65
RNG = np.random.default_rng(0)


def made_up_tables() -> MeshTables:
    pair, rows = gear_pair(), RNG.integers(0, ROWS, (18, 47)).astype(np.int32)
    start, length = pair.contact_start_m, 1.6 * pair.base_pitch_m
    rows[5, 7] = ROWS - 1
    stiffness = RNG.uniform(1e8, 2e8, (ROWS, POINTS))
    return MeshTables(start, start + length, length / (POINTS - 1), pair.base_pitch_m, stiffness, rows)


def made_up_teeth(teeth: int) -> ToothTables:
    kinds = np.arange(teeth, dtype=np.int32) % 2
    return ToothTables(RNG.uniform(0.0, 1e-5, (2, 33)), kinds, RNG.uniform(-1e-6, 1e-6, teeth))


def test_names_give_back_every_input_of_the_law() -> None:
    over = made_up_tables()
    missing = MissingMaterial(over.start_m, over.end_m, made_up_teeth(18), made_up_teeth(47))
    cells = (ROWS, POINTS - 1)
    contact = ContactTable(
        touch_m=RNG.uniform(0.0, 8e-6, (ROWS, POINTS)), column=RNG.uniform(size=cells), gain=RNG.uniform(size=cells),
        curves=RNG.uniform(size=(9, 7, 9, 8)), half_face_m=1e-2, unit_m=1e-6, lead_m=2e-6,
    )  # fmt: skip
    lubricated = AsperityTable(RNG.uniform(size=(2, 5, 6)), RNG.uniform(size=(5, 6)), 0.03, 0.001, 300.0, 9.0, 2.0)
    coupling = coupling_table(0.1, 0.02)
    found = law_tables(
        pair_law(
            over,
            missing,
            MeshConstants(0.033, 0.25, 8e-5),
            damping_ratio=DampingLaw(0.04, 0.02, 0.05),
            friction=FrictionLaw(lubricated, 0.11, 0.02),
            contact=contact,
            coupling_m_per_n=coupling,
        )
    )
    expected = {
        "stiffness": over.pair_stiffness_n_per_m, "table_of_pair": over.table_of_pair, "coupling_m_per_n": coupling,
        "missing_1": missing.pinion.profile_m, "missing_2": missing.gear.profile_m, "backlash_m": 8e-5,
        "kind_of_tooth_1": missing.pinion.kind_of_tooth, "kind_of_tooth_2": missing.gear.kind_of_tooth,
        "offset_1": missing.pinion.offset_m, "offset_2": missing.gear.offset_m, "line_of_action_m": 0.033,
        "contact.touch_m": contact.touch_m, "contact.column": contact.column, "contact.gain": contact.gain,
        "contact.curves": contact.curves, "contact.unit_m": 1e-6, "contact.lead_m": 2e-6,
        "contact.half_face_m": 1e-2, "rubs": True,
        "contact_ratio": 1.6,
        "friction.table.ratio": lubricated.ratio, "friction.table.fluid": lubricated.fluid, "friction.boundary": 0.11,
        "friction.slip_speed_m_s": 0.02, "friction.table.per_log": 2.0, "damping_structure_root_kg": 0.04,
        "damping_film_root_kg": 0.02, "damping_asperities_root_kg": 0.05, "start_m": over.start_m,
    }  # fmt: skip
    for name, value in expected.items():
        # Twice the ratio times the root of 0.25 kg is the ratio itself, but for the rounding of one multiplication.
        np.testing.assert_allclose(found[name], value, rtol=1e-14, err_msg=name)
        assert np.shape(found[name]) == np.shape(value), name


def test_a_plain_law_names_nothing_that_it_does_not_use() -> None:
    found = law_tables(law())
    assert not [name for name in found if name.startswith(("contact.", "coupling", "friction", "damping_film"))]
    assert found["rubs"] is False
    np.testing.assert_array_equal(found["stiffness"], tables().pair_stiffness_n_per_m)
    assert found["missing_1"][0, -1] > RELIEF.amount_m
