"""What if the speed changes within a record? Lines smear over frequency and stay sharp over orders."""

import sys

import matplotlib.pyplot as plt
import numpy as np

import siggen

ramp = "variation.speed={start_ratio: 0.6, end_ratio: 1.0}"
config = siggen.load_config("quickstart", ["duration_s=2", ramp, "operating_points=[{speed_hz: 34, torque_nm: 40}]"])
record = siggen.run(siggen.draw(config))
signal = record.channels["lid_vertical"]

figure, (above, below) = plt.subplots(2, 1, figsize=(8, 6), layout="constrained")
power, *_ = above.specgram(signal, NFFT=2048, Fs=record.fs_hz, noverlap=1536)
above.images[0].set_clim(10 * np.log10(power.max()) - np.array([70, 0]))
above.set(ylim=(0, 4000), xlabel="time [s]", ylabel="frequency [Hz]")
record.spectrum("lid_vertical").plot(below)
below.set(xlim=(0, 60), xlabel="order of the pinion's shaft", ylabel="amplitude [m/s²]")
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
