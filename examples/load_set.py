"""How do I load a set? Arrays of signals, states and gearboxes, split by gearbox."""

import sys

import matplotlib.pyplot as plt
import numpy as np

import siggen

config = siggen.load_config("quickstart", ["specimens=8", "duration_s=0.5"])
siggen.generate(config, "runs/examples", workers=0)  # a finished set is taken as it is
dataset = siggen.open("runs/examples")
signals, states, gearboxes = dataset["train"].arrays("lid_vertical")  # (records, samples), names, numbers
print(signals.shape, np.unique(states), np.unique(gearboxes))

figure, axes = plt.subplots(4, 1, figsize=(8, 7), sharex=True, sharey=True, layout="constrained")
time_s = np.arange(signals.shape[1]) / dataset.fs_hz
for axis, state in zip(axes, ("healthy", "slight", "moderate", "severe"), strict=True):
    own = (states == state) & (gearboxes == gearboxes[0])
    axis.plot(time_s, signals[own][0], lw=0.5)
    axis.set_title(state, loc="left")
    axis.set_ylabel("m/s²")
axes[-1].set_xlabel("time [s]")
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
