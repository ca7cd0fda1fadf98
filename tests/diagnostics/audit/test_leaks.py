"""Each planted leak gives exactly its finding; a set without leaks gives none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from planted_leaks import FOUND_AS, LEAKS, labelled, with_permuted_states
from planted_set import Plant, measured

from diagnostics.audit import condition_leaks
from diagnostics.audit import leaks as findings
from diagnostics.audit.condition_leaks import condition_layers
from diagnostics.audit.leaks import (
    chance_bound,
    likeness,
    permuted_states,
    separability_findings,
    simple_thresholds,
    told_shares,
    verdict,
)
from diagnostics.audit.measured_set import MeasuredSet
from siggen.keys.column import Role
from tests.diagnostics.column_roles import ListedRoles

LAYER = "state_told_by_"


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> MeasuredSet:
    return measured(Plant(), tmp_path_factory)


@pytest.fixture(scope="module")
def twice(tmp_path_factory: pytest.TempPathFactory) -> MeasuredSet:
    """Return a clean set with two records of every state of a gearbox at one operating point."""
    return measured(Plant(specimens=6, points=1, repeats=2), tmp_path_factory)


@pytest.fixture(autouse=True)
def few_permutations(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """A fifth of the permutations: how often clean sets are accused is asked by the slow test, with all of them."""
    if request.node.get_closest_marker("slow") is None:
        monkeypatch.setattr(condition_leaks, "PERMUTATIONS", 19)


def leaks(found: MeasuredSet) -> list[str]:
    return [finding.leak for finding in separability_findings(found)]


def named(found: MeasuredSet) -> list[str]:
    """Return the findings that name a cause; detectors of layers, which take nearly all the time, are not asked."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(findings, "condition_leaks", lambda *_: [])
        return leaks(found)


def relabelled(found: MeasuredSet, **columns: object) -> MeasuredSet:
    """Return the set with other columns, in the roles that siggen gives those of its own."""
    own = {name: ListedRoles().role(name) for name in columns}
    labels = {**found.labels, **{name: np.asarray(column) for name, column in columns.items()}}
    return replace(found, labels=labels, roles={**found.roles, **own})


def test_a_set_without_leaks_gives_no_finding(clean: MeasuredSet) -> None:
    assert leaks(clean) == []
    assert "No leak" in verdict([], 12)


def test_labels_of_the_damage_itself_and_of_what_follows_from_it_are_no_tie(clean: MeasuredSet) -> None:
    severe, state = clean.labels["state"] == "severe", clean.labels["state_id"].astype(float)
    of_damage = {"through_face": severe, "sink_depth_um": 12.0 * severe}
    follows = {"snr_lid_x_db": state, "contact_loss_share": state, "damage_count": state}
    assert leaks(relabelled(clean, **of_damage, **follows)) == []


@pytest.mark.parametrize(
    ("plant", "expected"),
    [
        (
            Plant(specimens=6, points=1, error_depth=0.0, one_tooth=True),
            ["healthy_without_sidebands", "constant_damage_phase_tacho"],
        ),
        (
            Plant(specimens=6, points=1, one_error_draw=True, shared_noise=True),
            ["one_error_draw", "noise_shared_by_records"],
        ),
        (
            Plant(specimens=6, points=1, padded_state="severe", copied_channel_noise=True, one_start=True),
            ["state_tied_to_duration_s", "noise_shared_by_channels", "constant_damage_phase_start"],
        ),
    ],
    ids=["sidebands_tooth", "errors_noise", "length_channels_start"],
)
def test_leaks_in_the_signals_give_exactly_their_findings(
    plant: Plant, expected: list[str], tmp_path_factory: pytest.TempPathFactory
) -> None:
    assert named(measured(plant, tmp_path_factory)) == expected


@pytest.mark.parametrize("layer", LEAKS)
def test_of_ten_leaks_one_per_layer_each_is_found_and_named(clean: MeasuredSet, layer: str) -> None:
    found = LEAKS[layer](clean)
    assert (leaks if FOUND_AS[layer].startswith(LAYER) else named)(found) == [FOUND_AS[layer]]


def test_detectors_see_no_label_of_damage_and_nothing_that_follows_from_it(clean: MeasuredSet) -> None:
    raw = {"edges", "offsets", "lines", "samples", "ends", "clock", "codes", "course", "blocks", "phases"}
    raw |= {"locked", "low_bits", "echoes"}
    assert set(condition_layers(clean)) == {"metadata", "texts", "order", "bytes", "noise", "channels"} | raw
    shown = [name for _, names in condition_layers(clean).values() for name in names]
    assert not {"record_id", "damaged_area_mm2", "snr_lid_x_db", "mesh_stiffness_loss"} & set(shown)


def test_pulses_are_held_against_the_first_shaft_whatever_it_is_called(clean: MeasuredSet) -> None:
    rate = clean.values["pulses_per_s"][:, 0]
    names = {"input": "input_shaft_hz", "output": "output_shaft_hz"}
    set_of_machine = replace(
        labelled(clean, input_shaft_hz=rate, output_shaft_hz=0.5 * rate), about={"shaft_hz": names}
    )
    values, columns = condition_layers(set_of_machine)["metadata"]
    assert (values[:, columns.index("distance of the pulses from the shaft's frequency")] == 0.0).all()


def test_what_a_state_changes_on_purpose_may_tell_it(clean: MeasuredSet) -> None:
    severe = clean.labels["state"] == "severe"
    rng = np.random.default_rng(1)
    lead_um = rng.uniform(0.0, 5.0, 12)[clean.labels["specimen_id"]] + rng.uniform(15.0, 30.0, severe.size) * severe
    keys = np.array([["manufacture.pitch_error_um"] if changed else [] for changed in severe] + [[]], dtype=object)[:-1]
    moved = replace(relabelled(clean, pitch_error_um=lead_um), sections={"pitch_error_um": "manufacture"})
    told = {name for _, names in condition_layers(moved).values() for name in names if "pitch_error_um" in name}
    assert {"pitch_error_um", "pitch_error_um that its gearbox has twice"} <= told
    on_purpose = replace(
        moved, labels={**moved.labels, "changed_keys": keys}, roles={**moved.roles, "changed_keys": Role.TARGET}
    )
    assert not any("pitch_error_um" in name for _, names in condition_layers(on_purpose).values() for name in names)


@pytest.mark.slow
def test_of_200_clean_sets_with_permuted_states_at_most_one_in_twenty_is_accused(clean: MeasuredSet) -> None:
    accused = [bool(leaks(with_permuted_states(clean, turn))) for turn in range(200)]
    assert sum(accused) <= 10


@pytest.mark.parametrize(
    ("column", "group"),
    [
        ("torque_nm", "operating_points"),
        ("speed_hz", "operating_points"),
        ("noise_floor_lid_x_m_s2", "sensors"),
        ("start_angle_rad", "operating_points"),
        ("pitch_error_um", "manufacture"),
        ("path_gain_lid_x", "condition"),
        ("damage_film_temperature", "condition"),
    ],
)
def test_a_small_shift_of_one_label_with_the_state_is_found_though_specimens_scatter_more(
    clean: MeasuredSet, column: str, group: str
) -> None:
    # 3 % with the state, where specimens scatter by 20 %: only differences within a specimen show it
    specimen = clean.labels["specimen_id"]
    scatter = np.random.default_rng(1).uniform(0.8, 1.2, int(specimen.max()) + 1)[specimen]
    values = scatter * (1.0 + 0.03 * clean.labels["state_id"])
    assert named(relabelled(clean, **{column: values})) == [f"state_tied_to_{group}"]


def test_status_by_state_is_found(clean: MeasuredSet) -> None:
    status = np.where(clean.labels["state"] == "severe", "ended_early", "ok")
    assert named(relabelled(clean, status=status)) == ["state_tied_to_provenance"]


def test_failures_that_gather_in_one_state_are_found_and_evenly_spread_ones_are_not(clean: MeasuredSet) -> None:
    config = {"states": {name: {} for name in clean.states()}}
    # 2 operating points, 1 repeat: records 4 and 5 of every 6 are the third state
    gathered = [{"record_id": 6 * specimen + 4} for specimen in range(60)]
    spread = [{"record_id": record} for record in range(60)]
    assert named(replace(clean, config=config, failures=gathered)) == ["state_tied_to_status"]
    assert named(replace(clean, config=config, failures=spread)) == []


def test_equal_error_labels_of_all_healthy_specimens_are_found(clean: MeasuredSet) -> None:
    damaged = ~clean.healthy
    values = np.where(damaged, clean.labels["pitch_error_um"], 3.0)
    assert "one_error_draw" in named(relabelled(clean, pitch_error_um=values))
    assert named(relabelled(clean, pitch_error_um=np.zeros(values.size))) == []


def test_a_specimen_in_two_splits_is_found(clean: MeasuredSet) -> None:
    split = clean.labels["split"].copy()
    split[0] = "train" if split[0] == "test" else "test"
    assert named(relabelled(clean, split=split)) == ["specimen_in_two_splits"]


def test_noise_that_few_records_share_in_twos_is_found(clean: MeasuredSet) -> None:
    sketches = [list(row) for row in clean.sketches]
    for record in (0, 20):
        sketches[record + 1][1] = sketches[record][1]
    assert named(replace(clean, sketches=sketches)) == ["noise_shared_by_records"]


def test_kurtosis_alone_that_separates_slight_is_found(clean: MeasuredSet) -> None:
    kurtosis = clean.values["kurtosis"] + 5.0 * (clean.labels["state"] == "slight")[:, None]
    assert named(replace(clean, values={**clean.values, "kurtosis": kurtosis})) == ["slight_separable_by_kurtosis"]


@pytest.mark.parametrize(
    ("gain_db", "expected"), [(9.5, ["slight_separable_by_rms"]), pytest.param(1.0, [], marks=pytest.mark.slow)]
)
def test_a_gain_of_damaged_records_is_found_where_gearboxes_differ_more(
    twice: MeasuredSet, gain_db: float, expected: list[str]
) -> None:
    """Levels of gearboxes are spread over 40 dB, so that no threshold on the rms alone tells a gain of three."""
    specimens, of_record = np.unique(twice.labels["specimen_id"], return_inverse=True)
    of_gearbox = 10.0 ** np.random.default_rng(3).permutation(np.linspace(-1.0, 1.0, specimens.size))
    gain = np.where(twice.healthy, 1.0, 10.0 ** (gain_db / 20.0)) * of_gearbox[of_record]
    changed = replace(twice, values={**twice.values, "rms": twice.values["rms"] * gain[:, None]})
    assert [finding.leak for finding in simple_thresholds(changed)] == expected


def test_a_gain_on_one_channel_is_found_beside_a_small_change_that_tells_as_well(twice: MeasuredSet) -> None:
    """1 dB on the channel that comes last by name tells the states too, and may be physics; 9.5 dB may not."""
    specimens, of_record = np.unique(twice.labels["specimen_id"], return_inverse=True)
    spread = 10.0 ** np.random.default_rng(3).permutation(np.linspace(-1.0, 1.0, specimens.size))
    # every record as loud as its gearbox: nothing but the gains differs
    rms = np.repeat(spread[of_record][:, None], len(twice.channels), axis=1)
    first, last = (twice.channels.index(choice(twice.channels)) for choice in (min, max))
    rms[~twice.healthy, first] *= 10.0 ** (9.5 / 20.0)
    rms[~twice.healthy, last] *= 10.0 ** (1.0 / 20.0)
    found = simple_thresholds(replace(twice, values={**twice.values, "rms": rms}))
    assert [finding.leak for finding in found] == ["slight_separable_by_rms"]
    assert twice.channels[first] in found[0].measured


def test_solver_settings_of_a_state_are_found(clean: MeasuredSet) -> None:
    states = {"healthy": {}, "slight": {"dynamics": {"steps_per_sample": 8}}}
    assert named(replace(clean, config={"states": states})) == ["solver_settings_by_state"]


def test_permuting_keeps_cells_whole_and_states_of_a_specimen_together() -> None:
    specimen, state = np.repeat(np.arange(5), 6), np.tile(np.repeat(np.arange(3), 2), 5)
    permuted = permuted_states(state, specimen, seed=0, count=50)
    assert permuted.shape == (50, 30)
    cells = permuted.reshape(50, 5, 3, 2)
    assert np.array_equal(cells[..., 0], cells[..., 1])
    assert np.array_equal(np.sort(cells[..., 0], axis=2), np.broadcast_to(np.arange(3), (50, 5, 3)))
    assert len({row.tobytes() for row in permuted}) > 40


def test_permuting_moves_states_among_specimens_that_have_one_state_each() -> None:
    specimen, state = np.repeat(np.arange(6), 2), np.repeat([0, 0, 0, 1, 1, 1], 2)
    permuted = permuted_states(state, specimen, seed=0, count=50)
    assert np.all(permuted.sum(axis=1) == 6)
    assert np.array_equal(permuted[:, ::2], permuted[:, 1::2])
    assert len({row.tobytes() for row in permuted}) > 10


def test_told_share_is_one_for_a_copy_and_zero_for_an_independent_code() -> None:
    state = np.tile(np.arange(3), 4)
    alone = np.stack([state, np.zeros_like(state)])
    assert told_shares(state, alone) == pytest.approx([1.0, 0.0])
    assert told_shares(np.repeat(np.arange(4), 3), alone) == pytest.approx([0.0, 0.0], abs=1e-12)


def test_likeness_is_one_up_to_rotation_and_below_the_bound_for_independent_phases() -> None:
    rng = np.random.default_rng(2)
    orders = [18 * h + k for h in range(1, 4) for k in range(-6, 7) if k]
    first = {order: complex(np.exp(2j * np.pi * rng.random())) for order in orders}
    turned = {order: 3.0 * value * np.exp(2j * np.pi * order * 0.1234) for order, value in first.items()}
    # the rotation lies up to 1/4096 off the grid of angles, which turns order 60 by 5 degrees
    assert likeness(first, turned) == (pytest.approx(1.0, abs=0.01), 36)
    other = [{order: complex(np.exp(2j * np.pi * rng.random())) for order in orders} for _ in range(200)]
    assert max(likeness(first, found)[0] for found in other) < chance_bound(36, 200)
