"""How do I simulate my own gearbox from a file? Numbers of its drawing as YAML; all else follows by rules."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import siggen

Path("my_gearbox.yaml").write_text("""
extends: bench
name: my_gearbox
gears: {module_mm: 2, face_width_mm: 20, pinion: {teeth: 25}, gear: {teeth: 56}}
dynamics: {rated_torque_nm: 60}
operating_points: [{speed_hz: [15, 25], torque_nm: 20}]
states:
  others: null
  healthy: {}
  spalled: {damage: {kind: irregular, gear: pinion, teeth: 1, profile_length_mm: 1, face_share: 1}}
""")
gearbox = siggen.draw(siggen.load_config("my_gearbox.yaml"), number=0)

axes = None
for state in ("spalled", "healthy"):
    axes = siggen.run(gearbox, state, duration_s=0.3).plot("lid_vertical", ax=axes)
axes.legend(["spalled", "healthy"])
axes.figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
