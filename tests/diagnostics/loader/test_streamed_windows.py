"""Windows of endless gearboxes: at equal angle steps, used so many times, the same after a stop."""

from __future__ import annotations

from contextlib import closing
from itertools import islice
from typing import Any

import pytest
import torch
from torch.utils.data import DataLoader

import siggen
from diagnostics.loader import StreamedWindows, StreamSettings
from siggen.errors import UsageError
from siggen.gearbox.design import SetDesign

QUICKEST = "tests/configs/linear_pits.yaml"
CHANGES = ("duration_s=0.4", "specimens=2", *(f"operating_points.{place}.speed_hz=[32, 35]" for place in range(2)))
"""8 records of 12 turns or more of a gearbox in 0.4 s of CPU."""


@pytest.fixture(scope="module")
def design() -> SetDesign:
    return siggen.load_config(QUICKEST, CHANGES)


def made(design: SetDesign, **other: Any) -> StreamedWindows:
    return StreamedWindows(siggen.stream(design, mixed=1, executor="serial"), **other)


def taken(windows: StreamedWindows, count: int) -> list[tuple[torch.Tensor, Any]]:
    with closing(iter(windows)) as found:  # type: ignore[type-var]
        return list(islice(found, count))


def same(first: list[tuple[torch.Tensor, Any]], second: list[tuple[torch.Tensor, Any]]) -> bool:
    return all(torch.equal(a, b) and y == z for (a, y), (b, z) in zip(first, second, strict=True))


@pytest.fixture(scope="module")
def thrice(design: SetDesign) -> list[tuple[torch.Tensor, Any]]:
    """All windows of a gearbox three times, and the first one of the next gearbox."""
    return taken(made(design, reuse=3), 49)


def test_each_window_comes_as_often_as_asked_before_the_next_gearboxes(
    design: SetDesign, thrice: list[tuple[torch.Tensor, Any]]
) -> None:
    windows = made(design)
    first = [one for record in next(iter(windows.stream.blocks())) for one in windows._windows(record)]
    assert 3 * len(first) + 1 == len(thrice)
    found = [x.numpy().tobytes() for x, _ in thrice]
    assert sorted(found[:-1]) == sorted(3 * [x.tobytes() for x, _ in first])
    assert found[:-1] != 3 * found[: len(first)]  # each pass in another order
    assert found[-1] not in found[:-1]  # the next gearboxes
    assert {y for _, y in thrice} == {0, 1}


def test_windows_go_on_from_a_place_that_was_stored(design: SetDesign, thrice: list[tuple[torch.Tensor, Any]]) -> None:
    first, second = made(design, reuse=3), made(design, reuse=3)
    begun = taken(first, 37)
    second.load_state_dict(first.state_dict())
    assert same(begun + taken(second, 12), thrice)
    other = made(design, reuse=3, target=lambda record: record["state"])
    with pytest.raises(UsageError, match=r"belongs to other windows: target 'diagnostics.*is_damaged' instead of"):
        other.load_state_dict(first.state_dict())


def test_a_place_that_is_loaded_ends_the_loop_that_runs(design: SetDesign) -> None:
    windows = made(design)
    with closing(iter(windows)) as loop:  # type: ignore[type-var]
        next(loop)
        windows.load_state_dict(windows.state_dict())
        with pytest.raises(UsageError, match=r"^the windows: received another loop or another place"):
            next(loop)


def test_batches_of_torch_are_the_windows_in_their_order(
    design: SetDesign, thrice: list[tuple[torch.Tensor, Any]]
) -> None:
    (x, y), *_ = islice(DataLoader(made(design, reuse=3), batch_size=8), 1)
    assert torch.equal(x, torch.stack([one for one, _ in thrice[:8]]))
    assert y.tolist() == [one for _, one in thrice[:8]]
    with pytest.raises(UsageError, match="give DataLoader num_workers=0"):
        next(iter(DataLoader(made(design), batch_size=8, num_workers=1)))


def test_what_cannot_be_is_refused_in_words(design: SetDesign) -> None:
    with pytest.raises(UsageError, match=r"^stream: received a str; allowed: what siggen.stream returns"):
        StreamedWindows("quickstart")
    with pytest.raises(UsageError, match=r"^reuse: received 0; allowed: whole numbers from 1"):
        made(design, reuse=0)
    with pytest.raises(UsageError, match=r"^settings: received the quantity 'torque'; allowed: acceleration"):
        made(design, settings=StreamSettings(quantity="torque"))
    with pytest.raises(UsageError, match=r"no record holds a window of 40 revolutions"):
        taken(made(design, settings=StreamSettings(revolutions=40)), 1)
    with pytest.raises(UsageError, match=r"belongs to other windows: reuse 2 instead of 1"):
        made(design).load_state_dict(made(design, reuse=2).state_dict())
