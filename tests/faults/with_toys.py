"""`python -m tests.faults.with_toys`: commands from standard input, with the toy registered."""

from siggen.faults.kinds import KINDS
from tests.faults.toy_hinge import ToyHinge
from tests.toy_process import serve

if __name__ == "__main__":
    KINDS.append(ToyHinge)
    serve()
