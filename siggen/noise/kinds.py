"""The sources that a sensor may have, in the order in which they are added: a new one is a line here."""

from siggen.noise.line_table import LineTable
from siggen.noise.mains import Mains
from siggen.noise.pink import PinkNoise
from siggen.noise.source import Source
from siggen.noise.spectrum import SensorDensity

SOURCES: list[type[Source]] = [PinkNoise, SensorDensity, LineTable, Mains]
