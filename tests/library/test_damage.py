"""Damage that is composed: its mesh stiffness as a curve, its pictures, states of a gearbox, a kind of one's own."""

from __future__ import annotations

from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
import pytest

import siggen
from siggen import Chip, Crack, Damage, Gear, GearPair, Pit, Spall, State, Wear, mesh_stiffness, pits_in_layers
from siggen.arrays import FloatArray
from siggen.damage.outlines import rectangle
from siggen.damage.spalls import FlankSpall
from siggen.errors import UsageError
from siggen.library.shape_fault import shape_of
from siggen.mesh.contact_table import contact_table
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions, face_slices
from siggen.views.stiffness import stiffness_curves

mpl.use("Agg")
PAIR = GearPair.of(teeth=(18, 47), module_mm=3.5, face_width_mm=20, bores_mm=(25, 40))


@dataclass(frozen=True)
class Dent(Damage):
    depth_um: float = 20.0

    def missing_m(self, gear: Gear, profile_m: FloatArray, face_m: FloatArray) -> FloatArray:
        along, across = (profile_m - 2e-3) / 0.4e-3, (face_m - 0.5 * gear.face_width_m) / 1e-3
        return 1e-6 * self.depth_um * np.exp(-(along**2) - across**2)


@dataclass(frozen=True)
class Loose(Damage):
    """Gives what is no depth for each point."""

    given: object = None

    def missing_m(self, gear: Gear, profile_m: FloatArray, face_m: FloatArray) -> FloatArray:
        return self.given  # type: ignore[return-value]


@dataclass(frozen=True)
class Groove(Damage):
    """Through the whole face: known to contacts as a spall too."""

    heights_m: tuple[float, float] = (1.6e-3, 2.2e-3)

    def missing_m(self, gear: Gear, profile_m: FloatArray, face_m: FloatArray) -> FloatArray:
        low, high = self.heights_m
        return np.where((profile_m >= low) & (profile_m <= high), 1e-3, 0.0 * face_m)


@dataclass(frozen=True)
class Slope(Damage):
    """The same all along the profile: known to contacts as misalignment."""

    def missing_m(self, gear: Gear, profile_m: FloatArray, face_m: FloatArray) -> FloatArray:
        return 5e-6 * face_m / gear.face_width_m + 0.0 * profile_m


def test_a_pair_of_a_drawing_is_that_of_a_file() -> None:
    config = siggen.load_config("paper_a")
    of_file = siggen.draw(config)._seats["pinion"].pair
    for key in ("pinion", "gear", "face_width_m", "youngs_modulus_pa", "poisson_ratio"):
        assert getattr(PAIR, key) == getattr(of_file, key)
    assert PAIR.driver.pitch_height_m == pytest.approx(1.934e-3, abs=1e-6)
    helical = GearPair.of((18, 47), 3.5, 20, helix_deg=12, shifts=(0.1, -0.1))
    assert helical.driver.module_m == pytest.approx(3.5e-3)
    assert helical.driver.transverse == helical.pinion
    assert helical.driven.transverse == helical.gear


def test_the_study_of_paper_a_is_a_loop_of_two_lines() -> None:
    """The curves of the preset, whose 16 pits of one row stand at 1.9 mm; elsewhere the loss moves with the pits."""
    config = siggen.load_config(
        "paper_a", [f"states.{name}.damage.teeth=[0]" for name in ("slight", "moderate", "severe")]
    )
    (of_file,) = (curve for curve in stiffness_curves(config.gearbox(0)) if curve.state == "moderate")
    sound, worst, losses = mesh_stiffness(PAIR, law="linear", tooth="base_circle"), [], []
    for height_mm in (1.0, 1.9, 2.8):
        pits = pits_in_layers("pinion", layers=1, pits_per_layer=16, first_height_mm=height_mm)
        curve = mesh_stiffness(PAIR, pits, law="linear", tooth="base_circle")
        loss = 1.0 - curve.stiffness_n_per_m / sound.stiffness_n_per_m
        worst.append(curve.angle_rad[np.argmax(loss)])
        losses.append(loss.max())
        if height_mm == 1.9:
            known = np.interp(curve.angle_rad, of_file.angle_rad, of_file.mesh_stiffness_n_per_m)
            assert np.mean(np.abs(curve.stiffness_n_per_m / known - 1.0) > 1e-3) < 0.02  # but where pairs come and go
    assert np.all(np.diff(worst) > 0.02)  # the contact climbs the driving flank
    assert losses[1] > max(losses[0], losses[2])  # in single contact nothing else carries


def test_a_state_of_a_gearbox_has_the_curve_of_its_mesh_under_the_torque_of_its_first_point() -> None:
    left_out = [f"states.{name}=null" for name in ("healthy_again", "moderate", "sham")]
    config = siggen.load_config("quickstart", [*left_out, "states.severe.grows=slight"])
    gearbox = siggen.draw(config, 1)
    torque_nm = gearbox.points[0].torque_nm
    curves = {state.name: mesh_stiffness(gearbox, state.name) for state in gearbox.states}
    for known in stiffness_curves(config.gearbox(1), torque_nm=torque_nm):
        assert np.array_equal(curves[known.state].angle_rad, known.angle_rad)
        assert np.array_equal(curves[known.state].stiffness_n_per_m, known.mesh_stiffness_n_per_m)
    assert f"{torque_nm:.3g}\u00a0N\u00a0m" in curves["healthy"].meaning
    loss = 1.0 - curves["severe"].stiffness_n_per_m / curves["healthy"].stiffness_n_per_m
    measured = siggen.run(gearbox, "severe", duration_s=0.1).labels["mesh_stiffness_loss_as_simulated"]
    assert loss.max() == pytest.approx(measured, rel=0.02)
    dented = gearbox.with_(State("dented", (Dent("pinion", depth_um=200.0),)))
    assert mesh_stiffness(dented, "dented").stiffness_n_per_m.min() < mesh_stiffness(dented).stiffness_n_per_m.min()


def test_a_gearbox_has_its_own_law_and_teeth_and_a_pair_one_mesh() -> None:
    gearbox = siggen.single_stage((23, 61), 2.5)
    for given, said in (
        ({"law": "linear"}, "law: received 'linear'; allowed: nothing for a gearbox"),
        ({"damages": "pitted"}, "damages: received 'pitted'; allowed: healthy"),
        ({"mesh": "slow"}, "mesh: received 'slow'; allowed: none, the gearbox has one mesh"),
        ({"torque_nm": 1e6}, r"torque_nm: received 1e\+06 N m; allowed: up to"),
    ):
        with pytest.raises(UsageError, match=said):
            mesh_stiffness(gearbox, **given)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="mesh: received 'slow'; allowed: nothing for a pair"):
        mesh_stiffness(PAIR, mesh="slow")


def test_a_hole_of_ones_own_lets_rigid_flanks_sink_as_a_spall_does() -> None:
    low, high = 1.6e-3, 2.2e-3
    outline = rectangle((low, high), (-1e-3, PAIR.face_width_m + 1e-3))
    known, own = (
        contact_table(PAIR, (one,), StiffnessOptions(), TableOptions(2000.0), points=513).touch_m[1]
        for one in (FlankSpall("pinion", 0, outline, 1e-3), shape_of(Groove(), PAIR.driver, "pinion"))
    )
    assert known.max() > 3e-6
    assert np.abs(own - known).max() < 0.04 * known.max()  # edges lie on points 5 µm apart


def test_a_shape_that_is_the_same_all_along_the_profile_is_a_misalignment() -> None:
    options, stiffness = TableOptions(2000.0), StiffnessOptions()
    slices = face_slices(PAIR, options)
    lead = 5e-6 * (np.arange(slices) + 0.5) / slices
    shaped = contact_table(PAIR, (shape_of(Slope(), PAIR.driver, "pinion"),), stiffness, options, points=129)
    leading = contact_table(PAIR, (), stiffness, options, points=129, lead_m=lead)
    middle = 64
    own = shaped.curves[round(float(shaped.column[1, middle]))][:, 0, 0]
    known = leading.curves[round(float(leading.column[0, middle]))][:, 0, 0]
    assert np.allclose(own, known, rtol=2e-2)
    assert shaped.touch_m[1, middle] == pytest.approx(leading.touch_m[0, middle] + leading.lead_m, abs=1e-9)


def test_a_dent_softens_the_mesh_where_it_is_and_nowhere_else() -> None:
    dents: tuple[list[Damage], ...] = ([], [Dent()], [Dent(depth_um=60.0)])
    sound, dented, deeper = (mesh_stiffness(PAIR, one, points_per_pitch=80) for one in dents)
    angle = np.degrees(sound.angle_rad)
    beside = (angle < 5.0) | (angle > 27.0)
    assert np.allclose(dented.stiffness_n_per_m[beside], sound.stiffness_n_per_m[beside], rtol=1e-12)
    losses = [1.0 - curve.stiffness_n_per_m / sound.stiffness_n_per_m for curve in (dented, deeper)]
    assert 0.005 < losses[0].max() < losses[1].max() < 0.1


def test_kinds_of_damage_act_on_a_gearbox_as_states_of_it() -> None:
    gearbox = siggen.single_stage((23, 61), 2.5).with_(
        State("pitted", pits_in_layers("pinion", layers=2, pits_per_layer=14, first_height_mm=1.4)),
        State("cracked", (Crack("gear", 3, depth_mm=1.0),)),
        State("chipped", (Chip(height_mm=1.0, width_mm=5.0),)),
        State("worn", (Wear(depth_um=10.0),)),
        State("spalled", (Spall(outline_mm=((1.2, 2), (2.2, 2), (2.2, 18), (1.2, 18))),)),
        State("rough", (siggen.BearingSpall("output.bearing", "inner"),)),
        State("dented", (Dent(depth_um=60.0),)),
        State("sham", (Pit(), Dent()), sham=True),
    )
    healthy = siggen.run(gearbox, speed_hz=25, torque_nm=40, duration_s=0.05)
    words = {}
    for state in gearbox.states[1:]:
        record = siggen.run(gearbox, state.name, 25, 40, duration_s=0.05)
        words[state.name] = record.labels["fault"]
        loss = float(str(record.labels["mesh_stiffness_loss_as_simulated"]))
        assert (loss > 0.0) == (state.name not in {"rough", "sham"})
        assert not any(np.array_equal(record.channels[one], values) for one, values in healthy.channels.items())
        assert record.labels["severity"] == ("healthy" if state.sham else state.name)
    assert words == {
        "pitted": "pitting", "cracked": "crack", "chipped": "chip", "worn": "wear", "spalled": "spalling",
        "rough": "bearing", "dented": "damage", "sham": "healthy",
    }  # fmt: skip


def test_flanks_are_drawn_to_scale_with_all_that_is_on_them() -> None:
    outline = ((1.0, 14.0), (3.0, 14.0), (3.5, 17.0), (1.5, 18.0))
    pits = siggen.random_pits("pinion", PAIR.driver, count=20, seed=1)
    axes = siggen.flank_picture(PAIR, [*pits, Spall(outline_mm=outline), Dent()])
    assert axes.get_aspect() == 1.0
    assert len(axes.collections) >= 3
    assert pits[:5] == siggen.random_pits("pinion", PAIR.driver, count=5, seed=1)
    x_mm = [
        corner[0] for patch in axes.patches for corner in patch.get_path().vertices if patch.get_facecolor()[0] > 0.5
    ]
    assert max(x_mm) <= 20.0 + 0.5


BAD = [
    (
        [Pit(height_mm=20.0)],
        r"^damages\[0\].height_mm: received height 20 mm; allowed: centre on the involute flank",
    ),
    ([Dent(), Pit("lid")], r"^damages\[1\].on: received 'lid'; allowed: pinion, gear"),
    ([Pit(tooth=40)], "tooth: received 40; allowed: a whole number from 0 to 17"),
    ([Crack(tooth=2.5)], r"^damages\[0\].tooth: received 2.5; allowed: a whole number"),  # type: ignore[arg-type]
    ([Chip(width_mm=30.0)], r"^damages\[0\].width_mm: received 30.0; allowed: above 0 up to 20, the face"),
    ([Dent(), Crack(), Pit(), Pit(depth_mm=9.0)], r"^damages\[3\].depth_mm: received depth 9 mm"),
    ([Spall(outline_mm=((1, 1), (2, 1), (2, 99)))], r"^damages\[0\].outline_mm: received face 50 mm"),
    ([Spall(outline_mm=((1, 1), (2, 1), (2, 3)), edge_radius_mm=9.0)], r"^damages\[0\].edge_radius_mm: received 9.0"),
    ([Pit(semi_axes_mm=(0.3, -1.0))], "semi_axes_mm: received -1.0; allowed: a number above 0"),
    ([Pit(semi_axes_mm=0.3)], "semi_axes_mm: received 0.3; allowed: two numbers in mm"),  # type: ignore[arg-type]
    ([Pit(face_mm="middle")], "face_mm: received 'middle'; allowed: a number"),  # type: ignore[arg-type]
    ([Crack(depth_mm=30.0)], r"depth_mm: received 30.0; allowed: above 0 up to 3"),
    ([Chip(height_mm=90.0)], "height_mm: received 90; allowed: up to 7.875, the height of the tooth"),
    ([Spall(outline_mm=((1, 2), (2, 3)))], "outline_mm: received .*; allowed: three corners or more"),
    ([Spall(outline_mm=((1, 2), (2, 4), (1.5, 2.5), (1, 4)))], "outline_mm: received an outline that crosses itself"),
    ([Dent(depth_um=-5.0)], r"^damages\[0\].missing_m: received depths from .*; allowed: finite depths of at least 0"),
    ([Pit(), Loose(given=1.0)], r"^damages\[1\].missing_m: received 1.0; allowed: an array \(\d+,\) of numbers \[m\]"),
    ([Loose(given=np.zeros(3))], r"^damages\[0\].missing_m: received an array \(3,\) of float64; allowed: an array"),
    ([Loose(given="deep")], "missing_m: received 'deep'; allowed: an array"),
    ([Damage()], r"damages\[0\]: received .*; allowed: a sequence of Pit, Spall, Crack"),
    ([Pit(), "pit"], r"damages\[1\]: received 'pit'; allowed: a sequence of Pit, Spall, Crack"),
    (Pit(), "damages: received Pit.*; allowed: a sequence of Pit, Spall, Crack"),
]


@pytest.mark.parametrize(("damages", "said"), BAD, ids=lambda one: str(one)[:40])
def test_damage_that_cannot_be_is_refused_in_words(damages: list[Damage], said: str) -> None:
    with pytest.raises(UsageError, match=said):
        mesh_stiffness(PAIR, damages)


def test_what_a_law_or_a_gearbox_has_not_is_refused() -> None:
    with pytest.raises(UsageError, match="law: received 'linear' with damage that is a shape of the flank"):
        mesh_stiffness(PAIR, [Dent()], law="linear")
    with pytest.raises(UsageError, match="torque_nm: received 1000000"):
        mesh_stiffness(PAIR, torque_nm=1e6)
    with pytest.raises(UsageError, match=r"points_per_pitch: received 10\.5; allowed: 1 to 100000"):
        mesh_stiffness(PAIR, points_per_pitch=10.5)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="pair: received 'pair'; allowed: a GearPair"):
        siggen.flank_picture("pair", [])  # type: ignore[arg-type]
    for given, said in (
        ({"teeth": (5, 6)}, r"teeth=\(5, 6\) of module 3 mm: "),
        ({"teeth": ("18", 47)}, r"teeth: received \('18', 47\); allowed: 2 whole numbers, such as \(18, 47\)"),
        ({"teeth": 18}, "teeth: received 18; allowed: 2 whole numbers"),
        ({"module_mm": "3"}, "module_mm: received '3'; allowed: a number"),
        ({"shifts": (0.1, "a")}, r"shifts: received \(0.1, 'a'\); allowed: 2 numbers"),
    ):
        with pytest.raises(UsageError, match=said):
            GearPair.of(**{"teeth": (18, 47), "module_mm": 3, **given})  # type: ignore[arg-type]
    gearbox = siggen.single_stage((23, 61), 2.5)
    for state, said in (
        (State("1st", (Pit(),)), "State.name: received '1st'; allowed: letters"),
        (State("healthy"), "State.name: received 'healthy'; allowed: a name that this gearbox has not yet"),
        (State("far", (Pit("sun"),)), r"State far: damages\[0\].on: received 'sun'; allowed: pinion, gear"),
        (State("far", (siggen.BearingSpall("lid"),)), "on: received 'lid'; allowed: input.bearing, output.bearing"),
        (State("deep", (Pit(depth_mm=5.0),)), r"State deep: damages\[0\].depth_mm: received depth 5 mm"),
        (State("bare", Pit()), "damages: received Pit.*; allowed: a sequence of Pit"),  # type: ignore[arg-type]
        (State("dent", (Dent(depth_um=-1.0),)), r"State dent: damages\[0\].missing_m: received depths from"),
    ):
        with pytest.raises(UsageError, match=said):
            gearbox.with_(state)
