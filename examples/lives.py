"""How does damage grow until a tooth fails? The worst tooth of two gearboxes, looked at every 5 hours."""

import sys

import matplotlib.pyplot as plt

import siggen

config = siggen.load_config("fleet", ["specimens=2", "duration_s=0.1", "life.interval_h=5"])
siggen.generate(config, "runs/examples_lives", workers=0)  # a finished set is taken as it is
dataset = siggen.open("runs/examples_lives")
inspections = dataset.life("inspections").to_pylist()
worst = dict.fromkeys((row["record_id"] for row in inspections), 0.0)
for tooth in dataset.life("teeth").to_pylist():  # one row for each inspection and pitted tooth
    worst[tooth["record_id"]] = max(worst[tooth["record_id"]], tooth["area_share"])

figure, axes = plt.subplots(layout="constrained")
for specimen in sorted({row["specimen_id"] for row in inspections}):
    own = [row for row in inspections if row["specimen_id"] == specimen]
    shares = [100 * worst[row["record_id"]] for row in own]
    axes.plot([row["age_h"] for row in own], shares, "o-", label=f"gearbox {specimen}")
axes.axhline(4, color="grey", ls="--", label="rated damage")
axes.set(xlabel="age [h]", ylabel="pitted share of the worst flank [%]")
axes.legend()
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
