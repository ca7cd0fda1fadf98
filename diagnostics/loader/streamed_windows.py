"""Windows of endless gearboxes for torch, each used so many times.

    stream = siggen.stream(siggen.load_config("quickstart"), mixed=32)
    for x, y in DataLoader(StreamedWindows(stream, reuse=8), batch_size=64):
        loss = step(x, y)

Where a network learns faster than gearboxes are simulated, `reuse` passes over the windows of the gearboxes that are
mixed at a time are made before the next ones come, each in another order.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from numbers import Integral
from typing import Any

import numpy as np
import torch
from torch.utils.data import IterableDataset, get_worker_info

from diagnostics.base.seeding import Purpose, generator
from diagnostics.loader.window_index import StreamSettings, window_starts
from diagnostics.records.state_classes import HEALTHY, SHAM
from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from siggen.errors import UsageError

MOST_REUSE = 1000


def is_damaged(record: Mapping[str, Any]) -> int:
    """Return 1 for a record with damage, 0 for a healthy one or a sham."""
    return int(record["fault"] not in (HEALTHY, SHAM))


class StreamedWindows(IterableDataset[tuple[torch.Tensor, Any]]):  # type: ignore[misc]  # the checker does not read torch
    """Endless (x, y): windows (channels, samples) float32 at equal angle steps, and what they are.

    Order and values depend on the stream's arguments, the settings and `reuse` alone. The stream has worker processes
    of its own: give `DataLoader` none.

    Parameters
    ----------
    stream : siggen RecordStream
        What `siggen.stream` returned.
    settings : StreamSettings, optional
        Default: windows of 8 revolutions of 288 angle steps, every 4 revolutions. Its classes have no use here.
    reuse : int
        How often each window comes.
    target : callable, optional
        Takes a record with its labels, and returns y; default: 1 for damage, 0 without it and for shams.

    Raises
    ------
    UsageError
        If an argument cannot be, a record is shorter than a window, or no channel holds the quantity.
    """

    def __init__(
        self,
        stream: Any,
        settings: StreamSettings | None = None,
        *,
        reuse: int = 1,
        target: Callable[[Mapping[str, Any]], Any] = is_damaged,
    ) -> None:
        chosen = settings or StreamSettings()
        if not hasattr(stream, "blocks"):
            raise UsageError(f"stream: received a {type(stream).__name__}; allowed: what siggen.stream returns")
        steps = getattr(chosen, "samples_per_revolution", None)
        if not isinstance(steps, int):
            raise UsageError(f"settings: received {chosen!r}; allowed: StreamSettings with a number of angle steps")
        if not callable(target):
            raise UsageError(f"target: received {target!r}; allowed: a function of a record")
        if isinstance(reuse, bool) or not isinstance(reuse, (int, Integral)) or not 1 <= reuse <= MOST_REUSE:
            raise UsageError(f"reuse: received {reuse!r}; allowed: whole numbers from 1 to {MOST_REUSE}")
        self.stream, self.settings, self.reuse, self.target = stream, chosen, int(reuse), target
        self.columns = tuple(one.column for one in stream.channels if chosen.quantity in (None, one.quantity))
        if not self.columns:
            held = ", ".join(sorted({one.quantity for one in stream.channels}))
            raise UsageError(f"settings: received the quantity {chosen.quantity!r}; allowed: {held}, or None")
        self._given = 0
        self._steps = steps
        self._reader: object = None

    def __iter__(self) -> Iterator[tuple[torch.Tensor, Any]]:
        """Yield windows from the present place on."""
        if get_worker_info() is not None:
            raise UsageError("num_workers: the stream has workers of its own; give DataLoader num_workers=0")
        self._reader = reader = object()
        for records in self.stream.blocks():
            windows = [one for record in records if record is not None for one in self._windows(record)]
            if not windows:
                turns = self.settings.revolutions
                raise UsageError(
                    f"settings: no record holds a window of {turns} revolutions; give a longer `duration_s`"
                )
            if self._given > self.reuse * len(windows):
                raise UsageError(
                    f"given: received {self._given}; allowed: up to {self.reuse * len(windows)} at this place"
                )
            block = self.stream.state_dict()["passed"]
            for number in range(self._given // len(windows), self.reuse):
                order = generator(self.stream.seed, Purpose.REPLAY, block, number).permutation(len(windows))
                for place in order[self._given - number * len(windows) :]:
                    self._given += 1
                    x, y = windows[place]
                    yield torch.from_numpy(x.copy()), y
                    if self._reader is not reader:
                        raise UsageError(
                            "the windows: received another loop or another place while this loop ran; allowed: one "
                            "loop at a time. Begin a loop after the place was loaded"
                        )
            self._given = 0

    def _windows(self, record: Mapping[str, Any]) -> Iterator[tuple[np.ndarray, Any]]:
        grid = angle_grid(record["tacho_s"], self._steps)
        fs_hz, y = self.stream.design.fs_hz, self.target(record)
        turned = np.stack([resample_to_angle(record[name], fs_hz, grid) for name in self.columns]).astype(np.float32)
        samples = self.settings.revolutions * self._steps
        for start in window_starts(record["tacho_s"], self.settings, fs_hz).values():
            if start + samples <= turned.shape[1]:
                yield turned[:, start : start + samples], y

    def state_dict(self) -> dict[str, Any]:
        """Return the place behind the last window as plain values."""
        return {"stream": self.stream.state_dict(), "given": self._given, **self._facts()}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go on where other windows were; the block of mixed gearboxes is simulated once more.

        Raises
        ------
        UsageError
            If they had another stream, other windows, another reuse or a target of another name.
        """
        if not isinstance(state, Mapping):
            raise UsageError(f"state: received {state!r}; allowed: what state_dict returned")
        facts, given = self._facts(), state.get("given")
        differing = [f"{name} {state.get(name)!r} instead of {facts[name]!r}" for name in facts
                     if state.get(name) != facts[name]]  # fmt: skip
        if differing:
            raise UsageError(f"the place belongs to other windows: {', '.join(differing)}")
        if type(given) is not int or given < 0:
            raise UsageError(f"given: received {given!r}; allowed: whole numbers from 0")
        self.stream.load_state_dict(state.get("stream"))
        self._given, self._reader = given, None

    def _facts(self) -> dict[str, Any]:
        chosen, target = self.settings, self.target
        return {
            "revolutions": chosen.revolutions, "hop_revolutions": chosen.hop_revolutions,
            "samples_per_revolution": self._steps, "reuse": self.reuse, "channels": list(self.columns),
            "target": f"{target.__module__}.{getattr(target, '__qualname__', type(target).__qualname__)}",
        }  # fmt: skip
