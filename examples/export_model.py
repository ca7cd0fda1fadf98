"""How do I take the model elsewhere? Its matrices as a file of numpy: here the response of the pinion to its mesh."""

import subprocess
import sys

import matplotlib.pyplot as plt
import numpy as np

subprocess.run(["siggen", "show", "quickstart", "--record", "0", "--out", "model.npz"], check=True, capture_output=True)
model = np.load("model.npz")
mass, damping, stiffness = (model[name] for name in ("mass", "damping", "stiffness"))
mesh = model["mesh.0.vector"]  # what a mesh deflection of 1 is made of
stiffness = stiffness + model["mesh.0.reference_stiffness_n_per_m"] * np.outer(mesh, mesh)

frequency_hz = np.geomspace(50, 10_000, 800)
omega = 2 * np.pi * frequency_hz
place = list(model["motion_names"]).index("pinion_shaft/vertical")
row = model["motion_rows"][place]
moved = [row @ np.linalg.solve(stiffness + 1j * w * damping - w**2 * mass, mesh) for w in omega]

figure, axes = plt.subplots(layout="constrained")
axes.loglog(frequency_hz, omega**2 * np.abs(moved))
axes.axvline(18 * float(model["speed_hz"]), color="grey", ls="--", label="mesh frequency")
axes.set(
    xlabel="frequency [Hz]", ylabel="acceleration over mesh force [m/s² per N]", title="shaft of the pinion, vertical"
)
axes.legend()
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
