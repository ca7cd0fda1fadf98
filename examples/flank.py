"""Where is the damage on the tooth? Pits round the pitch line and a spall, to scale on the flank."""

import sys

import matplotlib.pyplot as plt

import siggen

pair = siggen.GearPair.of(teeth=(23, 61), module_mm=2.5, face_width_mm=20)
pits = siggen.random_pits("pinion", pair.driver, count=12, seed=1)
spall = siggen.Spall("pinion", outline_mm=[(2.0, 2), (3.2, 2.5), (3.1, 17), (2.1, 18)], depth_mm=0.2)

figure, axes = plt.subplots(2, 1, figsize=(8, 6), layout="constrained")
siggen.flank_picture(pair, pits, axes[0])
siggen.flank_picture(pair, [spall], axes[1])
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
