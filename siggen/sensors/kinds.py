"""The kinds of sensors that a set may have: a new one is a line here."""

from siggen.sensors.accelerometer import Accelerometer
from siggen.sensors.bearing_force import ForceWasher
from siggen.sensors.coupling_torque import TorqueSensor
from siggen.sensors.encoder import Encoder
from siggen.sensors.motor_current import MotorCurrent
from siggen.sensors.sensor import SensorBase
from siggen.sensors.transmission_error import TransmissionError

KINDS: list[type[SensorBase]] = [Accelerometer, Encoder, TransmissionError, TorqueSensor, ForceWasher, MotorCurrent]
"""The first is what an entry without `kind` is."""
