"""What more gearboxes to learn from give: `python docs/scripts/more_gearboxes.py SET [--png FILE] [--states a,b]`.

From 40 deals of the gearboxes of SET: six are held out, and a detector learns on 3, 6, 12 and 18 of the others, each
time on the ones before and more. Prints the mean AUC of each state, and of all, against healthy records of other
gearboxes, of all indicators by ridge regression and of the best indicator alone, and the error of the last step.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

import diagnostics
import siggen
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.learners import BestColumn, GroupRidge, products
from diagnostics.statistics.evaluation import weighted_auc

SIZES, HELD_OUT, DEALS = (3, 6, 12, 18), 6, 40
RIDGE, BEST = "all indicators, ridge regression", "best indicator"
Found = dict[tuple[str, str], np.ndarray]
"""Detector and state -> AUC (deals, sizes)."""


def studied(matrix: FeatureMatrix, states: list[str]) -> Found:
    """Return the AUC of every detector, state, deal and number of gearboxes; records with undefined numbers are out."""
    state, specimen = matrix.labels["state"], matrix.groups
    wanted = np.isin(state, [*states, "healthy"])
    values = matrix.values[:, np.isfinite(matrix.values[wanted]).all(axis=0)]
    product, rng = products(values), np.random.default_rng(60)
    found = {(name, one): np.empty((DEALS, len(SIZES))) for name in (RIDGE, BEST) for one in (*states, "all")}
    for deal in range(DEALS):
        dealt = rng.permutation(np.unique(specimen))
        asked = wanted & np.isin(specimen, dealt[:HELD_OUT])
        for k, size in enumerate(SIZES):
            rows = np.flatnonzero(wanted & np.isin(specimen, dealt[HELD_OUT : HELD_OUT + size]))
            damaged, test = state[rows] != "healthy", np.flatnonzero(asked)
            ridge = GroupRidge(product).fit(rows, damaged[None, :], specimen[rows])
            best = BestColumn(matrix.names).fit(values[rows], damaged, specimen[rows])
            for name, score in ((RIDGE, ridge.score(test)[0]), (BEST, best.score(values[test]))):
                for one in (*states, "all"):
                    kept = np.isin(state[test], states if one == "all" else [one]) | (state[test] == "healthy")
                    positive, weights = state[test][kept] != "healthy", np.ones((1, int(kept.sum())))
                    auc = weighted_auc(score[kept], positive, weights, specimen[test][kept])[0]
                    found[name, one][deal, k] = float(auc)
    return found


def draw(found: Found, path: Path) -> None:
    """Draw the AUC over the number of gearboxes, a panel for each detector."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 3.4), layout="constrained")
    panels = dict(zip((RIDGE, BEST), figure.subplots(1, 2, sharey=True), strict=True))
    for (name, state), values in found.items():
        width = 3.0 if state == "all" else 1.2
        panels[name].plot(SIZES, values.mean(axis=0), marker="o", lw=width, label=state)
    for name, panel in panels.items():
        panel.set(title=name, xlabel="gearboxes to learn from", ylim=(0.45, 1.02), xticks=SIZES)
        panel.axhline(0.5, color="0.6", lw=0.8)
        panel.grid(alpha=0.3)
    panels[RIDGE].set_ylabel("AUC against healthy records [-]")
    panels[BEST].legend(fontsize=8)
    figure.savefig(path, dpi=110)


def main() -> None:
    """Print the table, and draw the figure if it is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("set", type=Path)
    parser.add_argument("--png", type=Path)
    parser.add_argument("--states", default="slight,moderate,severe")
    asked = parser.parse_args()
    found = studied(diagnostics.table(siggen.open(asked.set)), asked.states.split(","))
    print("| detector | state |", " | ".join(map(str, SIZES)), "| last over first |")
    print("|---" * (3 + len(SIZES)) + "|")
    for (name, state), values in found.items():
        rise = values[:, -1] - values[:, 0]
        cells = " | ".join(f"{mean:.2f}" for mean in values.mean(axis=0))
        print(f"| {name} | {state} | {cells} | {rise.mean():+.3f} ± {rise.std(ddof=1) / np.sqrt(DEALS):.3f} |")
    if asked.png:
        draw(found, asked.png)


if __name__ == "__main__":
    main()
