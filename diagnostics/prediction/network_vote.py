"""The network's probabilities for the windows of a recording."""

from __future__ import annotations

import numpy as np
import torch

from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import ShaftPulses
from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from diagnostics.training.cnn import WideKernelNetwork
from diagnostics.training.cnn_files import NetworkFile


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
