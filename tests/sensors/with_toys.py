"""`python -m tests.sensors.with_toys siggen|siggen-diagnostics ...`: the program, with the toys registered."""

import sys

from siggen.sensors.kinds import KINDS
from tests.sensors.toy_strain_gauge import ToyStrainGauge

if __name__ == "__main__":
    KINDS.append(ToyStrainGauge)
    if sys.argv[1] == "siggen":
        from siggen.cli.app import main
    else:
        from diagnostics.cli.app import main
    del sys.argv[0]
    sys.exit(main())
