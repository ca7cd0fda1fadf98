"""`python -m tests.faults.with_toys siggen|siggen-diagnostics ...`: the program, with the toys registered."""

import sys

from siggen.faults.kinds import KINDS
from tests.faults.toy_hinge import ToyHinge

if __name__ == "__main__":
    KINDS.append(ToyHinge)
    if sys.argv[1] == "siggen":
        from siggen.cli.app import main
    else:
        from diagnostics.cli.app import main
    del sys.argv[0]
    sys.exit(main())
