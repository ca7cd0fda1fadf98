"""The table of docs/start/own_gearbox.md: `python docs/scripts/init_losses.py [PAIRS] [GEARBOXES] [TURNS]`.

Which share of the records of `siggen init` machines leaves the model: gear pairs of module 0.8 to 8 mm and ratio 1 to
5, face width, shafts, bearings and accuracy as proposed for the torque that they are rated for. Gearboxes run in turn
at that torque, at a tenth of it and at none. A short record of every state is simulated, as `siggen plan` does; TURNS
other than its 8 says what longer records lose. 30 pairs with 3 gearboxes each take 6 minutes of CPU time on one core;
every pair is printed as soon as it is done.
"""

from __future__ import annotations

import sys
from dataclasses import replace

from siggen.checks.face_accuracy import covering_classes
from siggen.checks.loading import load_config
from siggen.config import inherited, parse_yaml
from siggen.rig.rig import Rig
from siggen.rig.rig_answers import rig_of
from siggen.rig.rig_text import rig_text
from siggen.rig.shafts import shafts
from siggen.sets import trial

MODULES_MM = (0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 8.0)
RATIOS = (1.0, 1.6, 2.5, 3.55, 5.0)
SPEED = "1450rpm"
LOADS = (1.0, 0.1, 0.0)
"""Over the torque that a machine is rated for."""


def rig(index: int) -> Rig:
    """Return one of the machines; three follow each other with one module."""
    pinion = 17 + 7 * index % 16
    gear = round(pinion * RATIOS[index % len(RATIOS)])
    given = {"teeth": f"{pinion},{gear}", "module": str(MODULES_MM[index // 3]), "speed": SPEED}
    found, _ = rig_of(given)
    return replace(found, accuracy_classes=covering_classes(found))


def row(one: Rig, gearboxes: int) -> tuple[str, list[trial.StateTrial]]:
    """Return the Markdown row of a machine, and what it loses."""
    written = inherited(parse_yaml(rig_text(one, "rig", "bench"), "rig"))
    (rated,) = written["operating_points"]
    points = [{**rated, "torque_nm": load * rated["torque_nm"]} for load in LOADS]
    config = load_config({**written, "operating_points": points, "specimens": gearboxes})
    found = trial.trial(config, gearboxes)
    sizes = [f"{shaft.diameter_mm:g} on {shaft.bearing.bore_mm:g} ({shaft.bearing.kind})" for shaft in shafts(one)]
    cells = [
        f"{one.module_mm:g}", "/".join(map(str, one.teeth)), f"{one.face_width_mm:g}", f"{one.torque_nm[1]:g}",
        ", ".join(sizes), ", ".join(map(str, one.accuracy_classes)), *(str(state.lost) for state in found),
    ]  # fmt: skip
    return f"| {' | '.join(cells)} |", list(found)


def main(pairs: int, gearboxes: int, turns: float) -> None:
    """Print a row per machine, evenly spread over all 30, and the shares of all of them together."""
    trial.TURNS = turns  # type: ignore[misc]
    states = ("healthy", "healthy again", "slight", "moderate", "severe", "sham")
    print(f"| module [mm] | teeth | face [mm] | torque [N m] | shafts [mm] | classes | {' | '.join(states)} |")
    print("|---" * (6 + len(states)) + "|", flush=True)
    lost = dict.fromkeys(states, 0)
    for place in range(pairs):
        text, found = row(rig(place * 30 // pairs), gearboxes)
        print(text, flush=True)
        for name, state in zip(states, found, strict=True):
            lost[name] += state.lost
    each = pairs * gearboxes
    print("", ", ".join(f"{name} {count} of {each} ({count / each:.1%})" for name, count in lost.items()), sep="\n")


if __name__ == "__main__":
    given = [float(number) for number in sys.argv[1:]]
    main(*(int(number) for number in (given + [30, 3][len(given) :])[:2]), given[2] if len(given) > 2 else trial.TURNS)
