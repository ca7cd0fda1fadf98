"""The probabilities that the network gives the pieces of a recording."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diagnostics.training.average_rows import AveragedRecords, padded_lines
from diagnostics.training.cnn import CircularNetwork, network_probability
from diagnostics.training.cnn_files import NetworkFacts


def network_probabilities(
    network: CircularNetwork, facts: NetworkFacts, waveforms: Sequence[Mapping[str, np.ndarray]], teeth: int
) -> np.ndarray:
    """Return the probability of every state in every piece, (pieces, states).

    Parameters
    ----------
    network : CircularNetwork
        In evaluation mode.
    facts : NetworkFacts
        Channels that it takes.
    waveforms : sequence of mapping of str to (orders,) complex64
        Lines of the first driver's average of every piece by channel.
    teeth : int
        Teeth of the first driver; any number will do.
    """
    lines = padded_lines([[piece[name] for name in facts.channels] for piece in waveforms])
    records = AveragedRecords(lines, np.full(len(lines), teeth), facts.channels)
    return network_probability(network, records)
