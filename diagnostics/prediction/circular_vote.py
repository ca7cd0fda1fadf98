"""The probabilities that the network on averages gives the pieces of a recording."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diagnostics.training.average_rows import AveragedRecords, padded_lines
from diagnostics.training.circular_files import CircularFacts
from diagnostics.training.circular_network import CircularNetwork, circular_probability


def circular_probabilities(
    network: CircularNetwork, facts: CircularFacts, waveforms: Sequence[Mapping[str, np.ndarray]], teeth: int
) -> np.ndarray:
    """Return the probability of every state in every piece, (pieces, states).

    Parameters
    ----------
    network : CircularNetwork
        In evaluation mode.
    facts : CircularFacts
        Channels that it takes.
    waveforms : sequence of mapping of str to (orders,) complex64
        Lines of the pinion's average of every piece by channel.
    teeth : int
        Teeth of the pinion; any number will do.
    """
    lines = padded_lines([[piece[name] for name in facts.channels] for piece in waveforms])
    records = AveragedRecords(lines, np.full(len(lines), teeth), facts.channels)
    return circular_probability(network, records)
