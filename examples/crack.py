"""What does a root crack do? It softens its tooth, more the deeper it is, and takes nothing of the flank."""

import sys

import matplotlib.pyplot as plt

import siggen

pair = siggen.GearPair.of(teeth=(23, 61), module_mm=2.5, face_width_mm=20)
axes = siggen.mesh_stiffness(pair, torque_nm=40).plot(label="healthy")
for depth_mm in (0.5, 1.0, 1.5):
    crack = siggen.Crack("pinion", depth_mm=depth_mm, angle_deg=60)
    siggen.mesh_stiffness(pair, [crack], torque_nm=40).plot(axes, label=f"{depth_mm} mm deep")
axes.legend()
axes.figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
