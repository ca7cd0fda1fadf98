"""What does a spall of the sun change in a planetary set? Lines of the sun rise round the mesh line."""

import sys

import matplotlib.pyplot as plt

import siggen

gearbox = siggen.planetary(teeth=(25, 26, 77), module_mm=2)
spall = siggen.Spall("sun", outline_mm=[(0.8, 0), (2.4, 0), (2.4, 16), (0.8, 16)], depth_mm=0.2)
gearbox = gearbox.with_(siggen.State("spalled_sun", (spall,)))

axes = None
for state in ("spalled_sun", "healthy"):
    record = siggen.run(gearbox, state, speed_hz=24, torque_nm=60, duration_s=0.6)
    axes = record.spectrum("output_vertical").plot(axes, around=1, label=state)
axes.legend(ncols=5, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)
axes.figure.savefig(sys.argv[1], bbox_inches="tight") if len(sys.argv) > 1 else plt.show()
