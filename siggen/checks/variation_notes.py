"""What varies within the records of a set, in sentences for its plan, and what the model leaves out of that."""

from __future__ import annotations

from collections.abc import Iterator

from siggen.dynamics.drive.slow_variation import SLOW_CORNER_HZ
from siggen.gearbox.possible import PossibleGearbox
from siggen.keys.number import Number, bounds
from siggen.specimen.shaft_forces import RATED_SPEED_HZ


def variation_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield what varies and which forces the shafts bring; nothing for constant speed and torque alone."""
    config = gearbox.config
    speed, torque, unbalance = config.variation.speed, config.variation.torque, config.dynamics.unbalance.grade_mm_s
    if (speed.start_ratio, speed.end_ratio) != (1.0, 1.0):
        yield f"speed runs from {_span(speed.start_ratio)} to {_span(speed.end_ratio)} times nominal over a record"
    slow, once = f"rms up to {SLOW_CORNER_HZ:g} Hz", "per revolution"
    for number, sentence in (
        (speed.random_rms, f"slow random speed of {_percent(speed.random_rms)} {slow}"),
        (speed.ripple_once, f"speed ripple of {_percent(speed.ripple_once)} once {once}"),
        (speed.ripple_twice, f"speed ripple of {_percent(speed.ripple_twice)} twice {once}"),
        (speed.slip, f"motor slip of {_percent(speed.slip)} at {gearbox.rated_nm:g} N m"),
        (torque.random_rms, f"slow random torque of {_percent(torque.random_rms)} {slow}"),
        (torque.load_once, f"load torque pulsates by {_percent(torque.load_once)} once {once} of its shaft"),
        (torque.line_ripple, f"motor torque pulsates by {_percent(torque.line_ripple)} at 100 Hz, twice the line"),
        (unbalance, f"unbalance of grade G{_span(unbalance)} at {RATED_SPEED_HZ:g} Hz"),
    ):
        if bounds(number)[1] > 0.0:
            yield sentence
    if config.variation.active and config.dynamics.rubbing == "mixed_ehl":
        yield "the oil film is that of the operating point; it does not follow the variation of speed and torque"


def reversal_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield whose torque may change its sign within a record, at the largest draws and rare random values."""
    then = {"load": "the load then drives", "motor": "the motor then brakes"}
    for body, least in gearbox.config.variation.least_torques.items():
        if least < 0.0:
            fall = f"{body} torque falls to {100.0 * least:.3g} % of its mean"
            yield f"{fall}: {then[body]}, and teeth may lose contact or touch on the other flank"


def _percent(number: Number) -> str:
    return f"{_span(number, 100.0)} %"


def _span(number: Number, times: float = 1.0) -> str:
    return "-".join(dict.fromkeys(f"{times * value:g}" for value in bounds(number)))
