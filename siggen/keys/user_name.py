"""Names that a user gives: what columns of Parquet files, places and labels may be called."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.keys.wording import AllowedText

PART = "[A-Za-z][A-Za-z0-9_]{0,39}"
SENSOR = "[A-Za-z][A-Za-z0-9_]{0,199}"
WORD = "[A-Za-z][A-Za-z0-9_-]{0,199}"
SENSOR_TEXT = "letters, digits and _, beginning with a letter, at most 200"
WORD_TEXT = "letters, digits, - and _, beginning with a letter, at most 200"
PartName = Annotated[
    str, Field(pattern=f"^{PART}$"), AllowedText("letters, digits and _, beginning with a letter, at most 40")
]
"""Of a gear, shaft or mesh: columns are composed of it."""
SensorName = Annotated[str, Field(pattern=f"^{SENSOR}$"), AllowedText(SENSOR_TEXT)]
"""Of a sensor: with an axis it is a column."""
StateName = Annotated[str, Field(pattern=f"^{WORD}$"), AllowedText(WORD_TEXT)]
"""Of a state and its labels, which columns hold as values."""
SetName = Annotated[
    str,
    Field(pattern="^[A-Za-z0-9][A-Za-z0-9_.-]{0,199}$"),
    AllowedText("letters, digits, '.', - and _, beginning with a letter or a digit, at most 200"),
]
