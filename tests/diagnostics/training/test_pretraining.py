"""A network that learns from streamed gearboxes: what it tells, and that it goes on to the bit where it was stopped."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch

import diagnostics
import siggen
from diagnostics.statistics.evaluation import weighted_auc
from diagnostics.training.gear_rows import ALONE, ROWS, STEPS
from diagnostics.training.gearbox_learner import NOWHERE, DamageTruth, GearboxLearner, learnt, told_loss
from diagnostics.training.gearbox_network import (
    WIDTHS,
    GearboxNetwork,
    load_gearbox_network,
    save_gearbox_network,
    shapes,
)
from diagnostics.training.loop import LoopSettings, fit_network, seeded
from diagnostics.training.pretraining import CARD, FAMILIES, WEIGHTS, PretrainingSettings, pair_splits
from siggen.errors import UsageError

KINDS = ("crack", "spalling")
FAMILY = """
extends: quickstart
specimens: 1
duration_s: 0.35
splits: {train: 12, validation: 4, test: 4}
states:
  others: null
  healthy: {}
  healthy_again: {}
  spall:
    damage:
      kind: irregular
      gear: either
      profile_length_mm: 1.0
      face_share: 0.5
      skew_mm_per_10mm: [-0.18, 0.18]
      waviness: [0.05, 0.1]
      edge_radius_mm: [0.02, 0.2]
"""


def planted(rng: np.random.Generator, records: int) -> tuple[np.ndarray, DamageTruth]:
    """Return noise of two gears, in half of the records with an event of 7 sigma on one of them, of two lengths."""
    rows = np.zeros((records, 1, 2, ROWS, STEPS), dtype=np.float16)
    rows[..., :ALONE, :] = rng.standard_normal((records, 1, 2, ALONE, STEPS))
    gear, kind = rng.integers(0, 2, records), rng.integers(0, 2, records)
    ill = np.arange(records) % 2 == 1
    for record in np.flatnonzero(ill):
        steps = (rng.integers(STEPS) + np.arange(1 + 5 * kind[record])) % STEPS
        rows[record, 0, gear[record], 0, steps] += 7.0 * (-1.0) ** np.arange(steps.size)
    size = np.where(ill, np.log(0.02 + 0.1 * kind), np.nan).astype(np.float32)
    return rows, DamageTruth(ill.astype(np.float32), np.where(ill, kind, NOWHERE), np.where(ill, gear, NOWHERE), size)


def test_planted_events_are_found_named_and_placed_in_records_that_were_not_learnt_from() -> None:
    rng = np.random.default_rng(0)
    (rows, truths), (asked, known) = planted(rng, 240), planted(rng, 120)
    with seeded(0):
        learner = GearboxLearner(KINDS, (8, 8), (-3.0, 1.0))

        def batches(_: int) -> Iterator[torch.Tensor]:
            for place in np.split(rng.permutation(len(rows)), 8):
                yield told_loss(learner(torch.from_numpy(rows[place, 0].astype(np.float32))), truths.chosen(place), 0.5)

        fit_network(learner, batches, None, LoopSettings(12, 1e-2, 0.1, falling=True))
    told = learnt(learner).tell(asked)
    ill = known.damaged > 0.0
    found = weighted_auc(told.damage.astype(float), ill, np.ones((1, ill.size)), np.arange(ill.size))
    assert found[0] > 0.95
    assert (told.gear.argmax(axis=1)[ill] == known.gear[ill]).mean() > 0.95
    assert (told.kind.argmax(axis=1)[ill] == known.kind[ill]).mean() > 0.8


def settled(seed: int) -> GearboxLearner:
    """Return a network whose normalisations have seen records, as after learning; evaluation mode."""
    rows, _ = planted(np.random.default_rng(seed), 8)
    with seeded(seed), torch.no_grad():
        learner = GearboxLearner(KINDS, WIDTHS, (-3.0, 1.0))
        for _ in range(20):
            learner(torch.from_numpy(rows[:, 0].astype(np.float32)))
    return learner.eval()


@pytest.mark.parametrize("beside", [False, True])
def test_the_network_that_answers_says_what_the_one_that_learns_says(beside: bool) -> None:
    rows, _ = planted(np.random.default_rng(3), 5)
    if beside:
        rows[:3, :, :, ALONE:] = np.random.default_rng(4).standard_normal(rows[:3, :, :, ALONE:].shape)
    learner = settled(3)
    with torch.no_grad():
        wanted = learner(torch.from_numpy(rows[:, 0].astype(np.float32)))
    told = learnt(learner).tell(rows)
    for name in ("damage", "kind", "gear", "size"):  # single precision, sums of a few hundred terms
        np.testing.assert_allclose(getattr(told, name), getattr(wanted, name).numpy(), rtol=1e-4, atol=1e-5)


def test_what_is_told_depends_on_neither_the_first_tooth_nor_the_order_of_gears() -> None:
    rows, _ = planted(np.random.default_rng(1), 6)
    network = learnt(settled(1))
    plain, turned = network.tell(rows), network.tell(np.roll(rows, 64, axis=-1))  # all strides together: 8 steps
    swapped = network.tell(rows[:, :, ::-1])
    for name in ("damage", "kind", "size"):
        np.testing.assert_allclose(getattr(plain, name), getattr(turned, name), atol=1e-4)
        np.testing.assert_allclose(getattr(plain, name), getattr(swapped, name), atol=1e-4)
    np.testing.assert_allclose(plain.gear, swapped.gear[:, ::-1], atol=1e-4)
    assert (np.diff(plain.size, axis=1) > 0.0).all()


def test_the_file_is_small_and_gives_the_network_back(tmp_path: Path) -> None:
    rows, _ = planted(np.random.default_rng(2), 4)
    network = learnt(settled(2))
    save_gearbox_network(network, tmp_path / WEIGHTS, {"fs_hz": 25600.0})
    again, facts = load_gearbox_network(tmp_path / WEIGHTS)
    assert facts["fs_hz"] == 25600.0
    assert sum(weight.size for weight in network.weights.values()) <= 500_000
    assert {name: weight.shape for name, weight in network.weights.items()} == shapes(len(KINDS), WIDTHS)
    assert (tmp_path / WEIGHTS).stat().st_size <= 5e6
    assert again.kinds == KINDS
    assert (network.tell(rows).damage == again.tell(rows).damage).all()
    (tmp_path / "other").write_bytes(b"no weights")
    with pytest.raises(UsageError, match="cannot be read as safetensors"):
        load_gearbox_network(tmp_path / "other")
    save_gearbox_network(GearboxNetwork(KINDS, (24, 32), network.weights), tmp_path / "other", facts)
    with pytest.raises(UsageError, match=r"another schema \(shape of of_gear\.weight\); train again"):
        load_gearbox_network(tmp_path / "other")
    network.limits.farthest = np.zeros((1, 3))
    save_gearbox_network(network, tmp_path / "other", facts)
    with pytest.raises(UsageError, match=r"another schema \(shape of farthest\); train again"):
        load_gearbox_network(tmp_path / "other")


class Stopped(Exception):
    """The process is ended."""


def test_a_training_that_was_stopped_twice_ends_with_the_same_bytes(tmp_path: Path) -> None:
    family = tmp_path / "family.yaml"
    family.write_text(FAMILY)
    settings = PretrainingSettings((str(family),), gearboxes=3, mixed=1, passes=3, batch=8, widths=(4, 4))

    def stopping(at: str) -> None:
        def say(line: str) -> None:
            if line.startswith(at):
                raise Stopped

        with pytest.raises(Stopped):
            diagnostics.pretrain(tmp_path / "stopped", settings, workers=0, say=say)

    stopping("family 1 of 1: 1 gearboxes")
    assert diagnostics.pretrain(tmp_path / "stopped", settings, workers=0, minutes=0.0) is None
    stopping("pass 2 of 3")
    threads = torch.get_num_threads()
    torch.set_num_threads(2)
    try:
        whole = diagnostics.pretrain(tmp_path / "whole", settings, workers=0)
    finally:
        torch.set_num_threads(threads)
    gone_on = diagnostics.pretrain(tmp_path / "stopped", settings, workers=0)
    assert whole == gone_on
    assert json.loads((tmp_path / "whole" / CARD).read_text()) == json.loads(json.dumps(whole))
    assert (tmp_path / "whole" / WEIGHTS).read_bytes() == (tmp_path / "stopped" / WEIGHTS).read_bytes()
    with pytest.raises(UsageError, match="holds a training with other passes, seed; allowed: another folder"):
        diagnostics.pretrain(tmp_path / "whole", PretrainingSettings((str(family),), 3, 1, 5, 8, widths=(4, 4), seed=1))


def test_a_pair_of_teeth_has_one_split_whatever_the_family_and_none_is_one_of_the_preset_of_unseen_gears() -> None:
    ours, preset = (
        {pair.teeth for pair in siggen.load_config(name).config.gears.pairs} for name in (FAMILIES[0], "families")
    )
    pairs = np.array(sorted(ours))
    splits = pair_splits(pairs)
    assert {name: round((splits == name).mean(), 2) for name in ("train", "validation", "test")} == {
        "train": 0.72, "validation": 0.11, "test": 0.17,
    }  # fmt: skip
    moved = np.random.default_rng(0).permutation(len(pairs))
    assert (pair_splits(pairs[moved]) == splits[moved]).all()
    assert not ours & preset


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"gearboxes": 0}, "gearboxes: received 0; allowed: whole numbers from 1 on"),
        ({"batch": 1}, "batch: received 1; allowed: whole numbers from 2 on"),
        ({"rate": float("nan")}, "rate: received nan; allowed: 0 to 1"),
        ({"families": "quickstart"}, "families: received 'quickstart'; allowed: names of configurations"),
        ({"families": ("two_stage",)}, "families: received two_stage with 2 meshes .* allowed: one pair of gears"),
    ],
)
def test_wrong_settings_are_refused_before_anything_is_simulated(
    wrong: dict[str, Any], said: str, tmp_path: Path
) -> None:
    with pytest.raises(UsageError, match=said):
        diagnostics.pretrain(tmp_path / "out", PretrainingSettings(**wrong), workers=0)
    assert not (tmp_path / "out").exists()
