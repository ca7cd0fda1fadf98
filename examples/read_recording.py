"""How do I read a logger's file without a tacho? The angle of the shaft comes from the mesh lines of the signal."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import siggen
from diagnostics.machine.recording_indicators import recording_indicators
from diagnostics.recordings.taken import RecordingFacts

# A simulated machine stands in for yours: 8 s of two channels in m/s².
gearbox = siggen.single_stage(teeth=(25, 56), module_mm=2)
record = siggen.run(gearbox, speed_hz=22, torque_nm=30, duration_s=8)
signals = np.stack(list(record.channels.values()), axis=1)
np.savetxt("may.csv", signals, delimiter=",", header="lid [m/s2],side [m/s2]", comments="", fmt="%.5g")

found = recording_indicators(Path("may.csv"), (25, 56), RecordingFacts(fs_hz=record.fs_hz), speed_range_hz=(14, 26))
print(found.pulses.origin)
print({name: round(value, 3) for name, value in found.values.items() if name.startswith(("rms", "fm4"))})

figure, axes = plt.subplots(layout="constrained")
axes.plot(found.pulses.times_s[1:], 1 / np.diff(found.pulses.times_s), label="by mesh lines")
axes.plot(record.tacho_s[1:], 1 / np.diff(record.tacho_s), "--", label="true pulses")
axes.set(xlabel="time [s]", ylabel="speed of the pinion [Hz]")
axes.legend()
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
