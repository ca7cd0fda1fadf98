"""What else than vibration shows damage: pictures of flanks, and metal in the oil."""

from __future__ import annotations

import io
from itertools import pairwise

import numpy as np
import pytest

from siggen.life.debris import CAUGHT, STEEL_MG_PER_M3, counted_mg
from siggen.life.picture import LAND, PIXEL_M
from siggen.seeding import Stream, named_generator
from tests.life.wearing import course


def seen(png: bytes) -> np.ndarray:
    """Return the greys of a picture, read by a library of its own."""
    from matplotlib.image import imread

    return np.asarray(imread(io.BytesIO(png), format="png")) * 255.0


@pytest.mark.parametrize("unit", range(4))
def test_a_picture_shows_the_area_that_is_gone(unit: int) -> None:
    one = course(unit)
    time = one.ends.functional
    teeth = {(tooth.gear, tooth.tooth): tooth for tooth in one.teeth(time)}
    for picture in one.pictures(time):
        truth, greys = teeth.pop((picture.gear, picture.tooth)), seen(picture.png)
        if truth.count > 1:
            continue  # pits of one tooth are of several greys
        dark = (LAND - greys) / (LAND - greys.min())  # the share of each pixel that is gone
        # half a grey of its rim of some 5 mm, and pits so small that they have little else than rim
        assert dark.sum() * PIXEL_M**2 == pytest.approx(truth.area_m2, rel=0.03, abs=0.03e-6)
    assert not teeth


def test_teeth_without_a_pit_share_one_picture_and_pits_only_darken_it() -> None:
    one = course(0)
    whole = one.pictures(0.0)
    assert [picture.gear for picture in whole] == ["pinion", "gear"]
    assert whole[0].png == course(1).pictures(0.0)[0].png
    times = np.linspace(one.ends.first_pit, one.ends.functional, 6)
    key = (one.pictures(times[0])[0].gear, one.pictures(times[0])[0].tooth)
    shown = [
        seen(picture.png) for time in times for picture in one.pictures(time) if (picture.gear, picture.tooth) == key
    ]
    assert len(shown) == len(times)
    for earlier, later in pairwise(shown):
        assert np.all(later <= earlier + 1e-3)
    assert shown[0].shape == (seen(whole[0].png)).shape


def test_a_counter_never_counts_back_and_counts_half_of_what_leaves() -> None:
    caught = []
    for unit in range(200):

        def named(name: str, unit: int = unit) -> np.random.Generator:
            return named_generator(5, Stream.LIFE, unit, name=name)

        readings = [counted_mg(0.0, age_h, named) for age_h in (0.0, 0.5, 3.2, 3.7, 40.0)]
        assert readings == sorted(readings)
        assert readings[0] == 0.0
        caught.append((counted_mg(1e-9, 3.2, named) - readings[2]) / (1e-9 * STEEL_MG_PER_M3))
    # 200 gearboxes of a deviation of 0.3: four standard errors
    assert np.median(np.log(caught)) == pytest.approx(np.log(CAUGHT), abs=4 * 1.25 * 0.3 / np.sqrt(200))


def test_metal_that_left_grows_from_nothing_and_is_area_times_depth() -> None:
    one = course(2)
    times = np.linspace(0.0, one.ends.functional, 12)
    volumes = [one.removed_m3(time) for time in times]
    assert volumes[0] == 0.0
    assert volumes == sorted(volumes)
    section = one.damage(times[-1])
    assert section is not None
    depths = [spall.depth_mm for spall in section.outlines]
    area_mm2 = 1e6 * sum(tooth.area_m2 for tooth in one.teeth(times[-1]))
    assert min(depths) * area_mm2 <= 1e9 * volumes[-1] <= max(depths) * area_mm2
