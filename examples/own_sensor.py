"""How do I add a sensor of my own? A class with one method: here the force in the pinion's bearing, in N."""

import sys

import matplotlib.pyplot as plt

import siggen


class ForceWasher:
    """Force in the first bearing, with white noise of 0.5 N."""

    def channels(self, gearbox):
        force = siggen.Reading("input.bearing", "vertical", order=0)
        return [siggen.Channel("washer", "N", [force], floor=0.5)]


gearbox = siggen.single_stage(teeth=(23, 61), module_mm=2.5)
spall = siggen.Spall("pinion", outline_mm=[(1.0, 0), (2.2, 0), (2.2, 20), (1.0, 20)], depth_mm=0.3)
gearbox = gearbox.with_(siggen.State("spalled", (spall,)), ForceWasher())

axes = None
for state in ("spalled", "healthy"):
    axes = siggen.run(gearbox, state, speed_hz=25, torque_nm=40, duration_s=0.2).plot("washer", ax=axes)
axes.legend(["spalled", "healthy"])
axes.figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
