"""Fits the committed coefficients again: those of the tooth, of neighbouring teeth, or of cracks."""

from __future__ import annotations

import argparse

from tests.reference.finite_elements.calibration_file import calibrate
from tests.reference.finite_elements.coupling_fit import couple
from tests.reference.finite_elements.crack_fit import fit_crack

FITS = {"calibrate": calibrate, "couple": couple, "fit_crack": fit_crack}


def main() -> None:
    """Run the fits that the command line names."""
    parser = argparse.ArgumentParser(prog="python -m tests.reference.finite_elements", description=__doc__)
    parser.add_argument("what", nargs="+", choices=FITS)
    for what in parser.parse_args().what:
        print(*FITS[what]().items(), sep="\n")


if __name__ == "__main__":
    main()
