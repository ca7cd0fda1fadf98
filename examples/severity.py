"""Does an indicator grow with the damage? FM4 of eight gearboxes over the damaged area: gearboxes scatter, too."""

import sys

import matplotlib.pyplot as plt
import numpy as np

import diagnostics
import siggen

config = siggen.load_config("quickstart", ["specimens=8", "duration_s=0.5"])
siggen.generate(config, "runs/examples", workers=0)  # a finished set is taken as it is
table = diagnostics.table(siggen.open("runs/examples"))
name = next(name for name in table.names if name.startswith("fm4_pinion"))
values = table.columns([name]).values[:, 0]

figure, axes = plt.subplots(layout="constrained")
for specimen in np.unique(table.groups):
    own = np.flatnonzero((table.groups == specimen) & (table.labels["state"] != "sham"))
    own = own[np.argsort(table.labels["damaged_area_mm2"][own])]
    axes.plot(table.labels["damaged_area_mm2"][own], values[own], "o-", lw=0.8, alpha=0.7)
axes.set(xlabel="damaged area [mm²]", ylabel=name, title="one line for each gearbox")
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
