"""`python -m tests.noise.with_toys ...`: siggen, with the toy registered."""

import sys

from siggen.noise.kinds import SOURCES
from tests.noise.toy_drift import ToyDrift

if __name__ == "__main__":
    SOURCES.append(ToyDrift)
    from siggen.cli.app import main

    sys.exit(main())
