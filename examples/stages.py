"""What does a gearbox of two stages sound like? Both meshes have lines and sidebands of their own."""

import sys

import matplotlib.pyplot as plt

import siggen

gearbox = siggen.machine(
    shafts={"input": {}, "middle": {"span_mm": 120}, "drum": {}},
    gears={
        "fast_pinion": {"shaft": "input", "teeth": 19},
        "fast_wheel": {"shaft": "middle", "teeth": 49},
        "slow_pinion": {"shaft": "middle", "teeth": 17},
        "slow_wheel": {"shaft": "drum", "teeth": 52},
    },
    meshes={
        "fast": {"gears": ("fast_pinion", "fast_wheel"), "module_mm": 2.5},
        "slow": {"gears": ("slow_pinion", "slow_wheel"), "module_mm": 4},
    },
    rated_nm=60,
)
record = siggen.run(gearbox, speed_hz=25, torque_nm=40)
axes = record.spectrum().plot()
axes.figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
