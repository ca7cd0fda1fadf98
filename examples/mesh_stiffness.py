"""How much mesh stiffness does a spall take? The curve drops while the damaged tooth carries."""

import sys

import matplotlib.pyplot as plt

import siggen

pair = siggen.GearPair.of(teeth=(23, 61), module_mm=2.5, face_width_mm=20)
axes = siggen.mesh_stiffness(pair, torque_nm=40).plot(label="healthy")
for width_mm in (8, 16):
    low, high = 10 - width_mm / 2, 10 + width_mm / 2
    spall = siggen.Spall("pinion", outline_mm=[(2.0, low), (3.2, low), (3.2, high), (2.0, high)], depth_mm=0.2)
    siggen.mesh_stiffness(pair, [spall], torque_nm=40).plot(axes, label=f"spall over {width_mm} of 20 mm")
axes.legend()
axes.figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
