"""Leakage between specimens is refused, and unusable splits are named."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.records.state_classes import class_ids, class_names, healthy_states
from diagnostics.training.splits import specimen_split
from siggen.errors import DatasetError


def labels(splits: list[str], states: tuple[str, ...] = ("healthy", "worn")) -> dict[str, np.ndarray]:
    """Return two records per specimen, one per state."""
    count = len(splits)
    return {
        "specimen_id": np.repeat(np.arange(count), len(states)),
        "split": np.repeat(splits, len(states)),
        "state": np.tile(states, count),
        "state_id": np.tile(np.arange(len(states)), count),
        "fault": np.tile(["healthy" if name.startswith("healthy") else "pitting" for name in states], count),
    }


def test_splits_are_those_of_the_set() -> None:
    split = specimen_split(labels(["train", "test", "train", "validation"]))
    assert split.train.tolist() == [True, True, False, False, True, True, False, False]
    assert split.test.sum() == 2
    assert split.classes == ("healthy", "worn")


def test_a_specimen_in_two_splits_is_refused() -> None:
    found = labels(["train", "test", "train"])
    found["split"][1] = "test"
    with pytest.raises(DatasetError, match="specimen 0 in test and train"):
        specimen_split(found)


@pytest.mark.parametrize(("splits", "missing"), [(["train", "train"], "test"), (["test"], "train")])
def test_a_split_without_specimens_is_named(splits: list[str], missing: str) -> None:
    with pytest.raises(DatasetError, match=f"split '{missing}' has no specimens"):
        specimen_split(labels(splits))


def test_a_single_state_is_refused() -> None:
    with pytest.raises(DatasetError, match=r"single state \['healthy'\]"):
        specimen_split(labels(["train", "test"], states=("healthy",)))


def test_states_keep_the_order_of_the_configuration() -> None:
    found = labels(["train", "train", "test"], states=("z_first", "a_second"))
    assert specimen_split(found).classes == ("z_first", "a_second")


def test_one_training_specimen_of_a_state_is_refused_with_the_way_out() -> None:
    with pytest.raises(DatasetError, match=r"one specimen of healthy, worn.*specimens=N"):
        specimen_split(labels(["train", "test"]))


TWICE = ("slight", "healthy", "worn", "healthy_again")


def test_healthy_states_are_one_class_under_the_name_of_the_first() -> None:
    found = labels(["train", "train", "test"], states=TWICE)
    split = specimen_split(found)
    assert split.classes == ("slight", "healthy", "worn")
    assert split.healthy == "healthy"
    assert split.members == {"slight": ("slight",), "healthy": ("healthy", "healthy_again"), "worn": ("worn",)}
    assert class_names(found)[:4].tolist() == ["slight", "healthy", "worn", "healthy"]
    assert found["state"][:4].tolist() == list(TWICE)  # the data keep their states
    assert class_ids(found) == {"slight": 0, "healthy": 1, "healthy_again": 1, "worn": 2}


def test_a_state_with_one_damaged_record_is_not_healthy() -> None:
    found = labels(["train", "train", "test"], states=TWICE)
    found["fault"][3] = "pitting"  # healthy_again of the first specimen
    assert healthy_states(found) == ("healthy",)
    assert specimen_split(found).classes == TWICE


def test_healthy_records_of_another_set_take_the_name_that_was_trained() -> None:
    other = labels(["test"], states=("healthy_reference", "worn"))
    assert class_names(other, "healthy").tolist() == ["healthy", "worn"]


def test_healthy_states_alone_are_refused() -> None:
    with pytest.raises(DatasetError, match=r"healthy states only \(healthy, healthy_again\).*Add damaged"):
        specimen_split(labels(["train", "train", "test"], states=("healthy", "healthy_again")))


def test_without_a_healthy_state_there_is_no_healthy_class() -> None:
    assert specimen_split(labels(["train", "train", "test"], states=("a", "b"))).healthy is None
