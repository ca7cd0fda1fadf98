"""`python -m tests.faults [part ...] [--quick] [--json FILE]`: faults made on purpose, an hour for all parts."""

import sys

from benchmarks.__main__ import main
from tests.faults import PARTS

if __name__ == "__main__":
    sys.exit(main("tests.faults", PARTS, ()))
