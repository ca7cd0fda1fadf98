"""How good is my own classifier? One call judges it on every gearbox, by what has learnt on others."""

import sys

import matplotlib.pyplot as plt
from sklearn.ensemble import RandomForestClassifier
from sklearn.impute import SimpleImputer
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

import diagnostics
import siggen

config = siggen.load_config("quickstart", ["specimens=8", "duration_s=0.5"])
siggen.generate(config, "runs/examples", workers=0)  # a finished set is taken as it is
table = diagnostics.table(siggen.open("runs/examples"))
forest = make_pipeline(SimpleImputer(strategy="median"), RandomForestClassifier(100, random_state=0))
logistic = make_pipeline(SimpleImputer(strategy="median"), StandardScaler(), LogisticRegression(C=0.01))

figure, axes = plt.subplots(layout="constrained")
for shift, (name, model) in enumerate({"random forest": forest, "logistic regression": logistic}.items()):
    judged = diagnostics.evaluate(model, table)
    found = [state.auc for state in judged.states.values()]
    limits = [[auc.value - auc.low for auc in found], [auc.high - auc.value for auc in found]]
    places = [place + 0.1 * shift for place in range(len(found))]
    axes.errorbar(places, [auc.value for auc in found], limits, fmt="o", capsize=4, label=name)
axes.axhline(0.5, color="grey", ls="--", label="chance")
axes.set_xticks(range(len(judged.states)), list(judged.states))
axes.set(ylabel="AUC against healthy records, 95 %", title=f"{judged.specimens} gearboxes, {judged.records} records")
axes.legend()
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
