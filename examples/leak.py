"""Does something else than damage give the state away? A sham, damage without effect, must look healthy."""

import sys
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
from sklearn.impute import SimpleImputer
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

import diagnostics
import siggen

config = siggen.load_config("quickstart", ["specimens=8", "duration_s=0.5"])
siggen.generate(config, "runs/examples", workers=0)  # a finished set is taken as it is
clean = diagnostics.table(siggen.open("runs/examples"))
clean.labels["sham"] = clean.labels["state"] == "sham"  # judged apart
offset = (clean.labels["state"] != "healthy") * 1.0 * np.nanstd(clean.values, axis=0)[:, None]  # somebody's mistake
leaky = replace(clean, values=clean.values + offset.T)
model = make_pipeline(SimpleImputer(strategy="median"), StandardScaler(), LogisticRegression(C=0.01))

figure, axes = plt.subplots(layout="constrained")
for shift, (name, table) in enumerate({"as simulated": clean, "with a planted leak": leaky}.items()):
    judged = diagnostics.evaluate(model, table)
    found = [state.auc for state in judged.states.values()] + [judged.sham]
    limits = [[auc.value - auc.low for auc in found], [auc.high - auc.value for auc in found]]
    places = [place + 0.1 * shift for place in range(len(found))]
    axes.errorbar(places, [auc.value for auc in found], limits, fmt="o", capsize=4, label=name)
axes.axhline(0.5, color="grey", ls="--", label="chance")
axes.set_xticks(range(len(found)), [*judged.states, "sham"])
axes.set_ylabel("AUC against healthy records, 95 %")
axes.legend()
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
