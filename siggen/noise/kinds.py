"""The sources that a sensor may have, in the order in which they are added: a new one is a line here."""

from siggen.noise.inverter import Inverter
from siggen.noise.line_table import LineTable
from siggen.noise.mains import Mains
from siggen.noise.pink import PinkNoise
from siggen.noise.source import Source
from siggen.noise.spectrum import SensorDensity
from siggen.noise.tones import Tones

SOURCES: list[type[Source]] = [PinkNoise, SensorDensity, LineTable, Mains, Tones, Inverter]
