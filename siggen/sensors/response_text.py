"""A measured frequency response as a text, so that a configuration holds it."""

from __future__ import annotations

import base64
from functools import lru_cache

import numpy as np

from siggen.keys.data_file import DataRefusal
from siggen.sensing.responses import FrequencyResponse

SINGLE = "f4;"
"""Before a response whose numbers are float32."""


def encoded_response(response: FrequencyResponse, numbers_as: str = "") -> str:
    """Return a response as a text: one line that names its curves, and its numbers in base64.

    With SINGLE numbers are float32, 1e-7 of a path that nobody knows to a per cent: a family fits into a file.
    """
    curves = [response.frequency_hz, *(part for c in response.curves.values() for part in (c.real, c.imag))]
    names = [f"{direction} {name}" for direction, name in response.curves]
    numbers = np.ascontiguousarray(curves, dtype="<f4" if numbers_as == SINGLE else "<f8").tobytes()
    return numbers_as + ",".join(names) + ":" + base64.b64encode(numbers).decode()


@lru_cache(maxsize=64)
def decoded_response(text: str) -> FrequencyResponse:
    """Return the response that a text stands for.

    Raises
    ------
    DataRefusal
        If it is none.
    """
    try:
        head, _, body = text.removeprefix(SINGLE).partition(":")
        keys = [(name.split(" ")[0], name.split(" ")[1]) for name in head.split(",")]
        width = "<f4" if text.startswith(SINGLE) else "<f8"
        raw = np.frombuffer(base64.b64decode(body, validate=True), width)
        numbers = raw.astype(np.float64).reshape(1 + 2 * len(keys), -1)
    except (ValueError, IndexError):
        raise DataRefusal("a text that holds no response", "allowed: what siggen filled in itself") from None
    curves = {key: numbers[1 + 2 * i] + 1j * numbers[2 + 2 * i] for i, key in enumerate(keys)}
    return FrequencyResponse(numbers[0], curves)
