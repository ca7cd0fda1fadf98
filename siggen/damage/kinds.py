"""The kinds of damage that a state may have: a new one is a line here."""

from siggen.damage.bearing_spall import BearingSpalls
from siggen.damage.chip import ChippedTeeth
from siggen.damage.crack import RootCracks
from siggen.damage.fault import Fault
from siggen.damage.irregular import IrregularSpalls
from siggen.damage.pits import ClusteredPits, LayeredPits, ListedPits
from siggen.damage.spalls import Spalls
from siggen.damage.wear import FlankWear

KINDS: list[type[Fault]] = [
    LayeredPits, ClusteredPits, Spalls, ListedPits, IrregularSpalls, RootCracks, ChippedTeeth, FlankWear, BearingSpalls,
]  # fmt: skip
