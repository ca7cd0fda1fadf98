"""How does a spalled bearing differ from a spalled tooth? Its impacts repeat in the envelope, at orders of no shaft."""

import sys

import matplotlib.pyplot as plt
import numpy as np
from scipy.signal import butter, hilbert, sosfilt

import siggen

gearbox = siggen.single_stage(teeth=(23, 61), module_mm=2.5)
gearbox = gearbox.with_(siggen.State("bearing", (siggen.BearingSpall("input.bearing", "outer", length_mm=2),)))

figure, axes = plt.subplots(layout="constrained")
for state in ("bearing", "healthy"):
    record = siggen.run(gearbox, state, speed_hz=25, torque_nm=40)
    signal = next(iter(record.channels.values()))
    band = sosfilt(butter(4, (2_000, 4_000), "bandpass", fs=record.fs_hz, output="sos"), signal)
    envelope = np.abs(hilbert(band))
    lines = 2 * np.abs(np.fft.rfft((envelope - envelope.mean()) * np.hanning(envelope.size))) / envelope.size
    frequency_hz = np.fft.rfftfreq(envelope.size, 1 / record.fs_hz)
    axes.plot(frequency_hz / record.speed_hz, lines, lw=0.9, label=state)
axes.set(xlim=(0, 20), xlabel="order of the pinion's shaft", ylabel="envelope, 2 to 4 kHz [m/s²]")
axes.legend()
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
