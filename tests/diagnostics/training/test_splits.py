"""Leakage between specimens is refused, and unusable splits are named."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.records.record_classes import FAULT, PRIMARY, STATE, record_classes
from diagnostics.records.state_classes import healthy_states
from diagnostics.training.splits import specimen_split
from siggen.errors import DatasetError, UsageError


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
    classes = record_classes(found)
    assert classes.of(found["state"])[:4].tolist() == ["slight", "healthy", "worn", "healthy"]
    assert found["state"][:4].tolist() == list(TWICE)  # the data keep their states
    assert classes.places(found["state"])[:4].tolist() == [0, 1, 2, 1]


def test_a_state_with_one_damaged_record_is_not_healthy() -> None:
    found = labels(["train", "train", "test"], states=TWICE)
    found["fault"][3] = "pitting"  # healthy_again of the first specimen
    assert healthy_states(found) == ("healthy",)
    assert specimen_split(found).classes == TWICE


def test_healthy_records_of_another_set_take_the_name_that_was_trained() -> None:
    other = labels(["test"], states=("healthy_reference", "worn"))
    assert record_classes(other, healthy="healthy").of(other["state"]).tolist() == ["healthy", "worn"]


def test_healthy_states_alone_are_refused() -> None:
    with pytest.raises(DatasetError, match=r"healthy states only \(healthy, healthy_again\).*Add damaged"):
        specimen_split(labels(["train", "train", "test"], states=("healthy", "healthy_again")))


def test_without_a_healthy_state_there_is_no_healthy_class() -> None:
    assert specimen_split(labels(["train", "train", "test"], states=("a", "b"))).healthy is None


DAMAGES = ("pit", "healthy", "pits_and_crack", "chip", "sham", "larger_pit")
WORDS = ("pitting", "healthy", "combined", "chip", "healthy", "pitting")


def damages(splits: list[str]) -> dict[str, np.ndarray]:
    """Two kinds of damage, one at once with another one, and a sham, whose fault is healthy."""
    found = labels(splits, states=DAMAGES)
    primary = [word if word != "combined" else "pitting" for word in WORDS]
    return found | {"fault": np.tile(WORDS, len(splits)), PRIMARY: np.tile(primary, len(splits))}


def test_states_of_one_primary_fault_are_one_class_and_a_sham_is_healthy() -> None:
    found = damages(["train", "train", "test"])
    split = specimen_split(found, record_classes(found, FAULT))
    assert split.kind == FAULT
    assert split.classes == ("pitting", "healthy", "chip")
    assert split.healthy == "healthy"
    assert split.members == {
        "pitting": ("pit", "pits_and_crack", "larger_pit"),
        "healthy": ("healthy", "sham"),
        "chip": ("chip",),
    }
    by_state = specimen_split(found, record_classes(found, STATE))
    assert by_state.classes == ("pit", "healthy", "pits_and_crack", "chip", "larger_pit")


def test_without_combined_states_the_fault_is_the_primary_one() -> None:
    found = labels(["train", "train", "test"], states=TWICE)
    assert record_classes(found, FAULT).class_of == {
        "slight": "pitting",
        "healthy": "healthy",
        "worn": "pitting",
        "healthy_again": "healthy",
    }


def test_the_healthy_fault_keeps_its_word_whatever_the_healthy_state_is_called() -> None:
    found = labels(["train", "train"], states=("as_delivered", "worn"))
    found["fault"] = np.tile(["healthy", "pitting"], 2)
    assert record_classes(found, FAULT).names == ("healthy", "pitting")
    assert record_classes(found).names == ("as_delivered", "worn")


def test_a_state_of_several_primary_faults_is_refused_with_the_way_out() -> None:
    found = labels(["train", "test"])
    found["fault"][1] = "crack"
    with pytest.raises(DatasetError, match=r"state worn: .* crack, pitting; allowed is one.*take states as classes"):
        record_classes(found, FAULT)


def test_an_unknown_kind_of_class_is_refused() -> None:
    with pytest.raises(UsageError, match="classes: received 'severity'; allowed are state, fault"):
        record_classes(labels(["train"]), "severity")


def test_messages_say_fault_where_classes_are_faults() -> None:
    found = labels(["train", "train", "test"], states=("slight", "worn"))
    assert specimen_split(found).classes == ("slight", "worn")
    with pytest.raises(DatasetError, match=r"the single fault \['pitting'\] \(slight, worn\).*two faults, of which"):
        specimen_split(found, record_classes(found, FAULT))
    few = damages(["train", "test"])
    with pytest.raises(DatasetError, match="that gearbox instead of its fault"):
        specimen_split(few, record_classes(few, FAULT))
