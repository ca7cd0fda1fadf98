"""How do I reproduce a figure of a paper? Mesh stiffness of paper A: healthy, slight, moderate and severe pits."""

import sys

import matplotlib.pyplot as plt

import siggen

pair = siggen.GearPair.of(teeth=(18, 47), module_mm=3.5, face_width_mm=20, bores_mm=(12.5, 20.0))
severities = {"healthy": None, "slight": (1, 8), "moderate": (1, 16), "severe": (3, 16)}  # layers, pits of a layer

axes = None
for name, layout in severities.items():
    pits = (
        ()
        if layout is None
        else siggen.pits_in_layers(
            "pinion",
            layers=layout[0],
            pits_per_layer=layout[1],
            first_height_mm=1.9,
            semi_axes_mm=(0.3, 0.2),
            depth_mm=0.4,
        )
    )
    curve = siggen.mesh_stiffness(pair, pits, law="linear", tooth="base_circle")
    axes = curve.plot(axes, label=name)
axes.legend(ncols=4)
axes.figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
