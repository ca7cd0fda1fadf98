"""The channels of a set that are asked for by name."""

from __future__ import annotations

import copy
from collections.abc import Sequence

from siggen.dataset.reading import Dataset
from siggen.errors import UsageError


def with_channels(dataset: Dataset, names: Sequence[str]) -> Dataset:
    """Return the set with the named channels only, in the set's order; all where none is named.

    Raises
    ------
    UsageError
        If the set has no channel of a name.
    """
    known = [channel.name for channel in dataset.channels]
    if unknown := [name for name in names if name not in known]:
        raise UsageError(f"--channel: received {', '.join(unknown)}; {dataset.path} has {', '.join(known)}")
    if not names:
        return dataset
    chosen = tuple(channel for channel in dataset.channels if channel.name in names)
    view = copy.copy(dataset)
    try:
        view.channels = chosen
    except AttributeError:  # a set whose channels are derived takes them from a class of its own
        view.__class__ = type("ChosenChannels", (type(dataset),), {"channels": chosen})
    return view
