"""`python -m tests.sensors.with_toys`: commands from standard input, with the toy registered."""

from siggen.sensors.kinds import KINDS
from tests.sensors.toy_strain_gauge import ToyStrainGauge
from tests.toy_process import serve

if __name__ == "__main__":
    KINDS.append(ToyStrainGauge)
    serve()
