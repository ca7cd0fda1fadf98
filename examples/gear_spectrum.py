"""What does a spalled tooth look like in the spectrum of a gearbox? Sidebands of its shaft rise at the mesh line."""

import sys

import matplotlib.pyplot as plt

import siggen

gearbox = siggen.single_stage(teeth=(23, 61), module_mm=2.5, face_width_mm=20)
spall = siggen.Spall("pinion", outline_mm=[(1.0, 0), (2.2, 0), (2.2, 20), (1.0, 20)], depth_mm=0.3)  # height, width
gearbox = gearbox.with_(siggen.State("spalled", (spall,)))

axes = None
for state in ("spalled", "healthy"):
    record = siggen.run(gearbox, state, speed_hz=25, torque_nm=40)
    axes = record.spectrum().plot(axes, around=4, label=state)
axes.legend(ncols=5, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)
axes.figure.savefig(sys.argv[1], bbox_inches="tight") if len(sys.argv) > 1 else plt.show()
