from fractions import Fraction
from math import pi

import numpy as np
import pytest

from siggen.gears.geometry.planetary import PlanetarySet, even_places, planetary_problems, typed_places
from siggen.gears.geometry.planetary_orders import passing_orders, shaft_orders, sideband_steps

EVEN = PlanetarySet(24, 27, 78, even_places(3))
UNEVEN = PlanetarySet(24, 27, 78, (Fraction(0), Fraction(33, 102), Fraction(70, 102)))
FOUR = PlanetarySet(20, 23, 66, typed_places([0.0, 92.093, 180.0, 272.093], 86))


@pytest.mark.parametrize("teeth", [EVEN, FOUR])
def test_pitch_circles_roll_on_each_other_without_slip(teeth: PlanetarySet) -> None:
    turns = {name: float(order) for name, order in shaft_orders(teeth).items()}
    centre = (teeth.sun + teeth.planet) * turns["carrier"]
    assert teeth.sun * turns["sun"] == pytest.approx(centre - teeth.planet * turns["planet"], rel=1e-13)
    assert centre + teeth.planet * turns["planet"] == pytest.approx(teeth.ring * turns["ring"], abs=1e-12)
    assert passing_orders(teeth)["mesh"] == teeth.sun * (shaft_orders(teeth)["sun"] - 1)


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


def test_a_fixed_sensor_sees_lines_at_the_permitted_orders_alone() -> None:
    """Any path, any mesh force, and a damaged tooth on each member; over the common turns, so that lines are exact."""
    generator = np.random.default_rng(5)
    turns, teeth = EVEN.common_turns, EVEN
    angle = np.arange(2**14) / 2**14 * turns
    path, mesh = generator.normal(size=4), generator.normal(size=3)

    def periodic(numbers: np.ndarray, turned: np.ndarray) -> np.ndarray:
        return np.asarray(sum(a * np.cos(2 * pi * i * turned + i * a) for i, a in enumerate(numbers)))

    def seen(faulty: str) -> np.ndarray:
        total = np.zeros(angle.size)
        for i, (place, phase) in enumerate(zip(teeth.places, teeth.phases, strict=True)):
            turned = {
                "healthy": np.zeros_like(angle),
                "sun": angle * teeth.ring / teeth.sun - float(place),
                "one planet": angle * teeth.ring / teeth.planet,
                "ring": angle + float(place),
            }[faulty]
            hit = 0.0 if faulty == "healthy" or (faulty == "one planet" and i > 0) else periodic(path[:3] + 1.0, turned)
            force = periodic(mesh, angle * teeth.ring + float(phase)) * (1.0 + hit)
            total = total + periodic(path, angle + float(place)) * force
        return np.abs(np.fft.rfft(total)) / total.size

    for faulty, steps in sideband_steps(teeth).items():
        heights = seen(faulty)
        found = np.flatnonzero(heights > 1e-9 * heights.max())
        units = [int(step * turns) for step in steps]
        apart = int(np.gcd.reduce(units))
        assert np.all(found % apart == 0), faulty
        assert found.size > 5
        if faulty == "healthy":
            assert all(teeth.carries_line(Fraction(int(order), turns)) for order in found)


@pytest.mark.parametrize(
    ("teeth", "planets"), [((24, 27, 78), 3), ((20, 23, 66), 4), ((21, 22, 67), 4), ((28, 16, 62), 5)]
)
def test_excitation_of_the_centre_follows_the_rule_of_phases(teeth: tuple[int, int, int], planets: int) -> None:
    one = PlanetarySet(*teeth, even_places(planets))
    directions = np.exp(2j * pi * np.array(one.places, float))
    for harmonic in range(1, 6):
        waves = np.exp(2j * pi * harmonic * np.array([-one.sun * place for place in one.places], float))
        torque = abs(waves.sum())
        push = max(abs((waves * directions).sum()), abs((waves * directions.conj()).sum()))
        found = "rotation" if torque > 1e-9 else "translation" if push > 1e-9 else "planets"
        assert one.excited(harmonic) == found


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
