"""Catalogues: numbers behind a word of the file, such as a sensor's model or how it is mounted, with their source."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

from siggen.errors import Problem
from siggen.keys.merging import merged
from siggen.keys.parser import Parser
from siggen.keys.problems import nearest_word, received_text, refusal


class CatalogueEntry(NamedTuple):
    """What a word stands for: keys as a file writes them, and where their numbers come from."""

    keys: Mapping[str, Any]
    source: str


_GAIN = {"normal": [1.0, 0.05], "within": [0.9, 1.1]}
_IEPE = {"gain": _GAIN, "high_pass_hz": {"log": [0.5, 2.0]}, "cross_axis": [0.03, 0.05]}
CATALOGUE: Mapping[str, Mapping[str, CatalogueEntry]] = {
    "variation": {
        "laboratory": CatalogueEntry(
            {
                "speed": {
                    "random_rms": {"log": [0.0002, 0.0006]},
                    "ripple_once": {"log": [0.0002, 0.0006]},
                    "ripple_twice": {"log": [0.0001, 0.0003]},
                },
                "torque": {"random_rms": [0.002, 0.01], "load_once": [0.005, 0.02], "line_ripple": [0.002, 0.01]},
            },
            "a controlled drive and brake (assumed)",
        ),
        "plant": CatalogueEntry(
            {
                "speed": {
                    "random_rms": [0.004, 0.012],
                    "ripple_once": {"log": [0.0002, 0.001]},
                    "ripple_twice": {"log": [0.0001, 0.0005]},
                    "slip": 0.03,
                },
                "torque": {"random_rms": [0.01, 0.05], "load_once": [0.01, 0.05], "line_ripple": [0.005, 0.02]},
            },
            "an induction motor and a load that wanders (assumed)",
        ),
    },
    "background": {
        "laboratory": CatalogueEntry(
            {
                "base": {},
                "rubbing": {"bursts": {}},
                "bearings": {},
                "machines": {},
                "shafts": {},
                "auxiliary_drive": {"order": [12, 60], "shaft_order": [0.3, 2.5]},
            },
            "all parts with their default ranges; orders of a pump or fan (assumed)",
        ),
    },
    "model": {
        "laboratory": CatalogueEntry(
            {
                **_IEPE,
                "noise": {"floor_m_s2": {"log": [0.003, 0.01]}},
                "range_m_s2": 500.0,
                "bits": "noise",
                "pink_noise": {"density_m_s2_per_sqrt_hz": {"log": [2.0e-5, 2.0e-4]}},
                "mains": {"amplitude_m_s2": {"log": [0.002, 0.02]}},
            },
            "a general accelerometer of 50 g, floor 0.3 to 1 mg (assumed)",
        ),
        "plant": CatalogueEntry(
            {
                **_IEPE,
                "noise": {"floor_m_s2": {"log": [0.003, 0.03]}},
                "range_m_s2": 500.0,
                "bits": 16,
                "resonance": {"frequency_hz": [25000, 50000], "damping_ratio": 0.03},
                "pink_noise": {"density_m_s2_per_sqrt_hz": {"log": [2.0e-5, 5.0e-4]}},
                "mains": {"amplitude_m_s2": {"log": [0.002, 0.05]}},
            },
            "the same with longer cables: floor 0.3 to 3 mg, more hum (assumed)",
        ),
        "shock": CatalogueEntry(
            {
                **_IEPE,
                "noise": {"floor_m_s2": {"log": [0.01, 0.05]}},
                "range_m_s2": 5000.0,
                "bits": 16,
                "pink_noise": {"density_m_s2_per_sqrt_hz": {"log": [2.0e-5, 2.0e-4]}},
                "mains": {"amplitude_m_s2": {"log": [0.002, 0.02]}},
            },
            "a shock accelerometer of 500 g, floor 1 to 5 mg (assumed)",
        ),
    },
    "mount": {
        "stud": CatalogueEntry(
            {"mounting": {"frequency_hz": [10000, 15000], "damping_ratio": 0.05}},
            "of a sensor of some 10 g, screwed down (assumed)",
        ),
        "magnet": CatalogueEntry(
            {"mounting": {"frequency_hz": [6000, 9000], "damping_ratio": 0.08}}, "the same on a magnet (assumed)"
        ),
        "any": CatalogueEntry(
            {"mounting": {"frequency_hz": [6000, 15000], "damping_ratio": [0.05, 0.08]}},
            "from magnet to stud (assumed)",
        ),
    },
}
"""Catalogue -> word -> entry."""


class CatalogueWord(Parser):
    """Parser of a key that holds a word of a catalogue; the section takes its numbers over before this key is read."""

    def __init__(self, catalogue: str) -> None:
        self._words = tuple(CATALOGUE[catalogue])
        self.allowed_text = f"one of {', '.join(self._words)}; or null"

    @property
    def documented(self) -> Any:
        """The words."""
        return Literal[self._words] | None

    def parse(self, value: object) -> None:
        """Return None, or raise a refusal of a word that is not there."""
        if value is not None:
            allowed = f"allowed: {self.allowed_text}{nearest_word(value, self._words)}"
            raise refusal([Problem("", received_text(value), allowed)])


def with_entries(value: Any, **catalogues: str) -> Any:
    """Return a raw section with the numbers of its words, below its own keys.

    Parameters
    ----------
    value : anything
        Only mappings change.
    **catalogues : str
        Key of the section -> catalogue that its word is of.
    """
    if not isinstance(value, Mapping):
        return value
    found: dict[str, Any] = {}
    rest = dict(value)
    for key, catalogue in catalogues.items():
        word = value.get(key)
        if isinstance(word, str) and word in CATALOGUE[catalogue]:
            found |= CATALOGUE[catalogue][word].keys
            del rest[key]
    return merged(found, rest) if found else value
