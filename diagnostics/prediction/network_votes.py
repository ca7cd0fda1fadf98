"""The network's probabilities for the windows of a recording.

The probabilities that the network on averages gives the pieces of a recording.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import torch

from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import ShaftPulses
from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from diagnostics.training.average_rows import AveragedRecords, padded_lines
from diagnostics.training.circular_files import CircularFacts
from diagnostics.training.circular_network import CircularNetwork, circular_probability
from diagnostics.training.cnn import WideKernelNetwork
from diagnostics.training.cnn_files import NetworkFile


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


def network_probabilities(
    network: WideKernelNetwork, facts: NetworkFile, recording: MeasuredRecording, pulses: ShaftPulses
) -> np.ndarray:
    """Return the probability of every state in every window, (windows, states).

    Parameters
    ----------
    network : WideKernelNetwork
        In evaluation mode.
    facts : NetworkFile
        Channels and windows it takes.
    recording : MeasuredRecording
        With these channels.
    pulses : ShaftPulses
        At least one more than a window has revolutions.
    """
    windows = facts.windows
    grid = angle_grid(pulses.times_s, windows.samples_per_revolution)
    signal = np.stack([resample_to_angle(recording.channels[name], recording.fs_hz, grid) for name in facts.channels])
    hop = windows.hop_revolutions * windows.samples_per_revolution
    starts = range(0, signal.shape[1] - windows.samples + 1, hop)
    cut = np.stack([signal[:, start : start + windows.samples] for start in starts]).astype(np.float32)
    with torch.no_grad():
        return np.asarray(torch.softmax(network(torch.from_numpy(cut)).double(), dim=1).numpy())
