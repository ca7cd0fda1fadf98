from fractions import Fraction

import numpy as np
import pytest

from siggen.gears.planetary import PlanetarySet, planetary_problems, typed_places
from tests.gears.builders import even_places

EVEN = PlanetarySet(24, 27, 78, even_places(3))
UNEVEN = PlanetarySet(24, 27, 78, (Fraction(0), Fraction(33, 102), Fraction(70, 102)))
FOUR = PlanetarySet(20, 23, 66, typed_places([0.0, 92.093, 180.0, 272.093], 86))


@pytest.mark.parametrize("teeth", [EVEN, UNEVEN, FOUR])
def test_phases_are_those_of_teeth_that_are_watched_as_they_pass(teeth: PlanetarySet) -> None:
    """Teeth seen from the carrier: when do some stand right before each planet, in pitches after the first one's?"""
    assert planetary_problems(teeth) == ()
    for count, sense, phases in ((teeth.sun, 1.0, teeth.sun_begins), (teeth.ring, -1.0, teeth.ring_begins)):
        for place, phase in zip(teeth.places, phases, strict=True):
            turned = sense * (np.arange(20_000) + 0.5) / 20_000 / count  # of the gear against the carrier, one pitch
            standing = (turned[:, None] + np.arange(count) / count - float(place) + 0.5) % 1.0 - 0.5
            passed = np.abs(standing).min(axis=1).argmin() / 20_000
            assert (passed + float(phase) + 0.5) % 1.0 == pytest.approx(0.5, abs=2e-4)  # two steps of the watching
    assert teeth.phases == tuple(begins % 1 for begins in teeth.ring_begins)


@pytest.mark.parametrize(
    ("teeth", "places", "words"),
    [
        ((24, 27, 79), even_places(3), "planet does not fit"),
        ((24, 27, 84), even_places(3), "ring and sun on one axis"),
        ((20, 44, 108), even_places(4), "neighbours touch"),
        ((24, 27, 78), even_places(2), "allowed: 3 to 5"),
        ((24, 27, 78), typed_places([0.0, 200.0, 100.0], 102), "ascending"),
        ((24, 27, 78), typed_places([0.0, 118.0, 240.0], 102), "next: 116.4706, 120.0000"),
    ],
)
def test_sets_that_cannot_be_put_together_are_refused_by_name(
    teeth: tuple[int, int, int], places: tuple[Fraction, ...], words: str
) -> None:
    assert words in " ".join(map(str, planetary_problems(PlanetarySet(*teeth, places))))
