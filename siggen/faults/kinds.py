"""The kinds of damage that a state may have: a new one is a line here."""

from siggen.faults.bearing_spall import BearingSpalls
from siggen.faults.chip import ChippedTeeth
from siggen.faults.clustered import ClusteredPits
from siggen.faults.crack import RootCracks
from siggen.faults.fault import Fault
from siggen.faults.irregular import IrregularSpalls
from siggen.faults.layered import LayeredPits
from siggen.faults.listed import ListedPits
from siggen.faults.spalls import Spalls
from siggen.faults.wear import FlankWear

KINDS: list[type[Fault]] = [
    LayeredPits, ClusteredPits, Spalls, ListedPits, IrregularSpalls, RootCracks, ChippedTeeth, FlankWear, BearingSpalls,
]  # fmt: skip
