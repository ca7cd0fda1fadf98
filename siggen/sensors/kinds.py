"""The kinds of sensors that a set may have: a new one is a line here."""

from siggen.sensors.accelerometer import Accelerometer
from siggen.sensors.encoder import Encoder
from siggen.sensors.sensor import Sensor

KINDS: list[type[Sensor]] = [Accelerometer, Encoder]
"""The first is what an entry without `kind` is."""
