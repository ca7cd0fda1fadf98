"""The converter of a sensor: how many bits it has, as the file says or as its noise asks for.

Digits below the noise cost bytes and say nothing. A step of a fifth of the standard deviation adds 1/300 of the
noise's power, 0.015 dB (derived: a uniform error of one step has the power step²/12).
"""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, PlainValidator

from siggen.errors import Problem
from siggen.keys.problems import received_text, refusal
from siggen.keys.section import Whole
from siggen.keys.wording import AllowedText
from siggen.sensing.measurement import converter_step

FEWEST_BITS, MOST_BITS = 4, 24
FROM_NOISE: Literal["noise"] = "noise"
STEPS_PER_FLOOR = 5.0
BITS = AllowedText(f"a whole number from {FEWEST_BITS} to {MOST_BITS}, {FROM_NOISE}, or null")


def _parsed(value: object) -> object:
    whole = isinstance(value, int) and not isinstance(value, bool) and FEWEST_BITS <= value <= MOST_BITS
    if whole or value is None or value == FROM_NOISE:
        return value
    raise refusal([Problem("", received_text(value), f"allowed: {BITS.allowed_text}")])


Bits: TypeAlias = Annotated[
    int | Literal["noise"] | None,
    PlainValidator(
        _parsed,
        json_schema_input_type=Annotated[Whole, Field(ge=FEWEST_BITS, le=MOST_BITS)] | Literal["noise"] | None,
    ),
    BITS,
]
BITS_TEXT = "of the converter; noise: as few as keep its step below a fifth of the floor; null: not quantised"


def bits_of_noise(limit: float, floor: float) -> int:
    """Return the fewest bits whose step is at most a fifth of a noise floor > 0; 24 where it would take more."""
    every = range(FEWEST_BITS, MOST_BITS)
    return next((n for n in every if STEPS_PER_FLOOR * converter_step(limit, n) <= floor), MOST_BITS)
