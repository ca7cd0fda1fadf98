"""`python -m tests.faults.victim_run STEP PLACE ...`: one step of making a small set of a preset.

A process of its own, so that it can be killed. Shards hold one gearbox each: a second of work lies between two commits.
As the command of siggen it imports next to nothing, since its workers import it first.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from siggen.gearbox.design import SetDesign

SPECIMENS, PARTS = 6, 3
"""Of the set that is killed, made in parts or extended."""

INTERNALS = "internals={quantities: [mesh_force_n]}"
SPALL = "severity: severe, damage: {kind: irregular, teeth: 1, profile_length_mm: 0.5, face_share: 0.5, gear: "
TWO_STATES = {gear: f"states={{healthy: {{}}, spall: {{{SPALL}{gear}}}}}}}" for gear in ("pinion", "sun")}
OVERRIDES = {
    "quickstart": (INTERNALS, TWO_STATES["pinion"]),
    "families": (TWO_STATES["pinion"],),
    "fleet": ("life.most=3",),
    "planetary": (TWO_STATES["sun"],),
    "bench": (INTERNALS, TWO_STATES["pinion"]),
}
"""Of each preset: a set of pairs that differ, lives, planets, and all that `bench` has, in short records."""


def short_set(preset: str = "quickstart", specimens: int = SPECIMENS) -> SetDesign:
    """Return a preset (of quickstart casing, tooth pairs, contact across the face) with short records."""
    import siggen

    return siggen.load_config(preset, ["duration_s=0.04", *OVERRIDES[preset], f"specimens={specimens}"])


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a step; return the exit code of a command."""
    from siggen.errors import SiggenError

    given = _arguments(arguments)
    if given.memory_mb:
        import resource

        # of address space, for this process and its workers: what `ulimit -v` sets
        resource.setrlimit(resource.RLIMIT_AS, (given.memory_mb << 20, resource.RLIM_INFINITY))
    try:
        _run(given)
    except SiggenError as error:
        sys.stderr.write(f"{error}\n")
        return error.exit_code
    except MemoryError:
        sys.stderr.write("not enough memory; finished shards stay\n")
        return 1
    return 0


def _run(given: argparse.Namespace) -> None:
    from siggen.sets.generation import generate

    part = (given.part, PARTS) if given.step == "part" else None
    who = {"executor": given.executor, "address": given.address}
    generate(short_set(given.preset, given.specimens), given.place, given.workers, part=part, **who)


def _arguments(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.faults.victim_run", description=__doc__)
    parser.add_argument("step", choices=("generate", "part"))
    parser.add_argument("place")
    parser.add_argument("--preset", choices=OVERRIDES, default="quickstart")
    parser.add_argument("--executor", default="processes")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--address")
    parser.add_argument("--memory-mb", type=int, default=0)
    parser.add_argument("--part", type=int, default=1)
    parser.add_argument("--specimens", type=int, default=SPECIMENS)
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
