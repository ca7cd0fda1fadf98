"""Is my own indicator better than those that are there? Its place among all 430, on one set."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from sklearn.metrics import roc_auc_score

import diagnostics
import siggen

Path("my_indicators.py").write_text('''
import numpy as np


def tooth_ratio(signal, tacho, gears):
    """Largest mean envelope of a tooth's sector of the turn, over the median of all sectors."""
    time_s = np.arange(signal.size) / gears.fs_hz
    inside = (time_s >= tacho[0]) & (time_s < tacho[-1])
    turns = np.interp(time_s[inside], tacho, np.arange(tacho.size))
    sector = np.floor(turns % 1.0 * gears.teeth_pinion).astype(int)
    level = np.bincount(sector, np.abs(signal[inside])) / np.bincount(sector)
    return float(level.max() / np.median(level))
''')
config = siggen.load_config("quickstart", ["specimens=8", "duration_s=0.5"])
siggen.generate(config, "runs/examples", workers=0)  # a finished set is taken as it is
table = diagnostics.table(siggen.open("runs/examples"), indicators=["my_indicators:tooth_ratio"])
rows = np.isin(table.labels["state"], ["healthy", "severe"])
values, damaged = table.values[rows], table.labels["state"][rows] == "severe"
known = np.isfinite(values).all(axis=0)
auc = {n: roc_auc_score(damaged, v) for n, v in zip(np.array(table.names)[known], values.T[known], strict=True)}

figure, axes = plt.subplots(layout="constrained")
axes.hist(auc.values(), bins=25, color="lightgrey", label=f"all {len(auc)}")
for name in (name for name in auc if name.startswith("tooth_ratio")):
    axes.axvline(auc[name], color="C3" if "lid" in name else "C0", label=name)
axes.set(xlabel="AUC of severe damage, eight gearboxes", ylabel="indicators")
axes.legend()
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
