"""Train a network on thousands of streamed gearboxes, or go on: `python docs/scripts/pretrain.py runs/pretrained`.

`--minutes 75` ends a call at the next place from which the same call goes on; Ctrl-C and a kill lose a pass at most. At
the end the folder holds network.safetensors and card.json, whose scores are printed.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import diagnostics
from diagnostics.training.pretraining import FAMILIES


def main() -> None:
    """Train, and print how far it is."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("folder")
    asked.add_argument("--minutes", type=float)
    asked.add_argument("--gearboxes", type=int, default=diagnostics.PretrainingSettings().gearboxes)
    asked.add_argument("--seed", type=int, default=0)
    asked.add_argument("--family", choices=[Path(name).stem for name in FAMILIES], help="one of them; default: all")
    given, begun = asked.parse_args(), time.monotonic()

    def say(line: str) -> None:
        print(f"{(time.monotonic() - begun) / 60.0:6.1f} min  {line}", flush=True)

    families = tuple(name for name in FAMILIES if given.family in (None, Path(name).stem))
    settings = diagnostics.PretrainingSettings(families, gearboxes=given.gearboxes, seed=given.seed)
    card = diagnostics.pretrain(given.folder, settings, minutes=given.minutes, say=say)
    for side, scores in (card["scores_of_unseen_pairs"] if card else {}).items():
        for name, value in scores.items():
            limits = f"{value['value']} ({value['low']} to {value['high']})" if isinstance(value, dict) else value
            print(f"{side:7} {name:24} {limits}")


if __name__ == "__main__":  # workers import the script
    main()
