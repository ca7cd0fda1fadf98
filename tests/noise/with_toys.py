"""`python -m tests.noise.with_toys`: commands from standard input, with the toy registered."""

from siggen.noise.kinds import SOURCES
from tests.noise.toy_drift import ToyDrift
from tests.toy_process import serve

if __name__ == "__main__":
    SOURCES.append(ToyDrift)
    serve()
