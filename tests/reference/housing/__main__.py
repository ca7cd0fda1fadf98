"""Prints the tables of the housing's checks."""

from __future__ import annotations

import argparse

from tests.reference.housing import limits, solid_comparison

TABLES = {
    "solid": solid_comparison.solid_table,
    "ten_more": solid_comparison.ten_more_table,
    "refinement": solid_comparison.refinement_table,
    "reach": limits.reach_table,
    "limits": limits.limits_table,
}


def main() -> None:
    """Print the tables that the command line names: `solid` (some minutes) without an argument."""
    parser = argparse.ArgumentParser(prog="python -m tests.reference.housing", description=__doc__)
    parser.add_argument("what", nargs="*", default=["solid"], choices=[*TABLES])
    for what in parser.parse_args().what:
        print(f"\n{what}\n")
        for row in TABLES[what]():
            print(row, flush=True)


if __name__ == "__main__":
    main()
