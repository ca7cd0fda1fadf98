"""Sets that cannot be trained or judged on are refused with what is wrong and the way out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest

from diagnostics.base.progress import silent_stage
from diagnostics.judging.of_split import NetworkOptions, check_device, train_models, training_metrics
from diagnostics.judging.sets import OtherSet, check_other_set, set_table
from diagnostics.records.usable_records import with_channels
from siggen.errors import DatasetError, UsageError

OTHER = {"identity": "1" * 64, "name": "other"}


def with_samples(dataset: Any, change: Callable[[np.ndarray], np.ndarray]) -> Any:
    """The set with the vertical channel of record 4 changed."""
    name = "accel_bearing_vertical_m_s2"
    table = dataset.table
    samples = table.column(name).combine_chunks()
    values = samples.flatten().to_numpy().reshape(table.num_rows, -1).copy()
    values[4] = change(values[4])
    column = pa.FixedSizeListArray.from_arrays(pa.array(values.ravel()), values.shape[1])
    return replace(dataset, table=table.set_column(table.schema.get_field_index(name), name, column))


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (lambda signal: np.full_like(signal, 3.5), "is constant in 1 record"),
        (lambda signal: np.where(np.arange(signal.size) == 100, np.nan, signal), "not finite in 1 record"),
    ],
    ids=["constant", "nan"],
)
def test_an_unusable_channel_is_named_with_the_way_to_leave_it_out(
    make_dataset: Callable[..., Any], change: Callable[[np.ndarray], np.ndarray], text: str
) -> None:
    broken = with_samples(make_dataset(("train",) * 3), change)
    with pytest.raises(DatasetError) as caught:
        set_table(broken, silent_stage)
    for part in ("memory_set", "channel bearing_vertical", text, "(4)", "--channel bearing_horizontal"):
        assert part in str(caught.value)
    table = set_table(with_channels(broken, ["bearing_horizontal"]), silent_stage)
    assert not any(name.endswith("bearing_vertical") for name in table.column_names)


def test_an_unknown_channel_is_named_with_the_known_ones(dataset: Any) -> None:
    with pytest.raises(UsageError, match=r"received top; .* has bearing_vertical, bearing_horizontal"):
        with_channels(dataset, ["top"])


def test_a_set_without_faults_says_what_to_add(make_dataset: Callable[..., Any]) -> None:
    whole = make_dataset(("train",) * 3 + ("test",) * 2)
    healthy = replace(whole, table=whole.table.filter(pc.equal(whole.table.column("state"), "healthy")))
    with pytest.raises(DatasetError, match=r"single state \['healthy'\].*Add damaged"):
        train_models(healthy, set_table(healthy, silent_stage), 0)


def test_other_sets_must_match_in_channels_rate_and_states(dataset: Any) -> None:
    other = replace(dataset, manifest=OTHER, path=Path("second"))
    check_other_set(dataset, other)
    table = other.table
    renamed = pc.replace_substring(pc.replace_substring(table.column("state"), "severe", "broken"), "slight", "worn")
    renamed_table = table.set_column(table.schema.get_field_index("state"), "state", renamed)
    cases = [
        (dataset, "is the set that is trained on"),
        (with_channels(other, ["bearing_vertical"]), "received the channels bearing_vertical; .*--channel"),
        (replace(other, fs_hz=6400.0), "received a sampling rate of 6400 Hz.*`fs_hz: 12800`"),
        (replace(other, table=renamed_table), "has the states broken, worn, .*allowed are healthy, severe, slight and"),
    ]
    for found, message in cases:
        with pytest.raises(UsageError, match=message):
            check_other_set(dataset, found)


def test_another_set_is_judged_by_the_classifiers_of_the_first(
    dataset: Any, features: pa.Table, make_dataset: Callable[..., Any]
) -> None:
    other = replace(make_dataset(("test",) * 6, seed=9), manifest=OTHER)
    judged_on = OtherSet(other, set_table(other, silent_stage))
    training = train_models(dataset, features, 0, network=NetworkOptions(cnn=False), other=judged_on)
    by_name = {found.name: found for found in training.other}
    assert set(by_name) == {"indicators", "boosting", "rms"}
    assert by_name["indicators"].scores.records == 18
    assert by_name["indicators"].scores.macro_auroc.value > 0.85
    metrics = training_metrics(training)
    assert set(metrics["classifiers_on_other_set"]) == set(by_name)
    better = next(p for p in metrics["comparisons"] if (p["first"], p["second"]) == ("indicators", "rms"))
    assert better["macro_auroc"]["low"] > 0.0


@pytest.mark.parametrize(("built_for", "found"), [("12.6", "finds no CUDA device"), (None, "built without CUDA")])
def test_unknown_and_absent_devices_are_refused(
    built_for: str | None, found: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    import torch

    with pytest.raises(UsageError, match="received 'tpu'; allowed are cpu, cuda"):
        check_device("tpu")
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    monkeypatch.setattr(torch.version, "cuda", built_for)
    with pytest.raises(UsageError, match=rf"--device cuda: .*{found}.*; leave --device out to train on the CPU"):
        check_device("cuda")
