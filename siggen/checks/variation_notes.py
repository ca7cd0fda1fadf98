"""What varies within the records of a set, in sentences for its plan, and what the model leaves out of that."""

from __future__ import annotations

from collections.abc import Iterator

from siggen.config import Config
from siggen.config.config import rated_nm
from siggen.config.variation import RARE
from siggen.dynamics.drive.slow_variation import SLOW_CORNER_HZ
from siggen.keys.number import Number, bounds
from siggen.specimen.shaft_forces import RATED_SPEED_HZ


def variation_notes(config: Config) -> tuple[str, ...]:
    """Return what varies and which forces the shafts bring; nothing for constant speed and torque alone."""
    return (*_speed(config), *_torque(config), *_forces(config), *_limits(config))


def reversal_notes(config: Config) -> tuple[str, ...]:
    """Return whose torque may change its sign within a record, at the largest draws and rare random values."""
    return tuple(_reversals(config))


def _speed(config: Config) -> Iterator[str]:
    speed = config.variation.speed
    if (speed.start_ratio, speed.end_ratio) != (1.0, 1.0):
        yield f"speed runs from {_span(speed.start_ratio)} to {_span(speed.end_ratio)} times nominal over a record"
    if _some(speed.random_rms):
        yield f"slow random speed of {_percent(speed.random_rms)} rms up to {SLOW_CORNER_HZ:g} Hz"
    for number, often in ((speed.ripple_once, "once"), (speed.ripple_twice, "twice")):
        if _some(number):
            yield f"speed ripple of {_percent(number)} {often} per revolution"
    if _some(speed.slip):
        yield f"motor slip of {_percent(speed.slip)} at {rated_nm(config.dynamics, config.operating_points):g} N m"


def _torque(config: Config) -> Iterator[str]:
    torque = config.variation.torque
    if _some(torque.random_rms):
        yield f"slow random torque of {_percent(torque.random_rms)} rms up to {SLOW_CORNER_HZ:g} Hz"
    if _some(torque.load_once):
        yield f"load torque pulsates by {_percent(torque.load_once)} once per revolution of its shaft"
    if _some(torque.line_ripple):
        yield f"motor torque pulsates by {_percent(torque.line_ripple)} at 100 Hz, twice the line"


def _reversals(config: Config) -> Iterator[str]:
    torque = config.variation.torque
    slow = RARE * bounds(torque.random_rms)[1]
    for body, number, then in (
        ("load", torque.load_once, "the load then drives"),
        ("motor", torque.line_ripple, "the motor then brakes"),
    ):
        least = 1.0 - slow - bounds(number)[1]
        if least < 0.0:
            fall = f"{body} torque falls to {100.0 * least:.3g} % of its mean"
            yield f"{fall}: {then}, and teeth may lose contact or touch on the other flank"


def _forces(config: Config) -> Iterator[str]:
    unbalance = config.dynamics.unbalance
    if _some(unbalance.grade_mm_s):
        yield f"unbalance of grade G{_span(unbalance.grade_mm_s)} at {RATED_SPEED_HZ:g} Hz"


def _limits(config: Config) -> Iterator[str]:
    if config.variation.active and config.dynamics.rubbing == "mixed_ehl":
        yield "the oil film is that of the operating point; it does not follow the variation of speed and torque"


def _some(number: Number) -> bool:
    return bounds(number)[1] > 0.0


def _percent(number: Number) -> str:
    return _range(*(100.0 * value for value in bounds(number))) + " %"


def _span(number: Number) -> str:
    return _range(*bounds(number))


def _range(low: float, high: float) -> str:
    return f"{low:g}" if low == high else f"{low:g}-{high:g}"
