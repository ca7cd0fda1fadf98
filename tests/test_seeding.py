"""Generators: the same owner always gets the same stream, and no two owners share one."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.seeding import OWNER_KEYS, Stream, generator, named_generator, named_uniforms

KEYS = st.integers(0, 2**40)


def first_draws(seed: int, stage: Stream, *owner: int) -> tuple[int, ...]:
    # 128 bits: two of a thousand streams agree by chance with a probability of 1e-33
    return tuple(int(x) for x in generator(seed, stage, *owner).integers(0, 2**64, size=2, dtype=np.uint64))


@given(st.integers(0, 2**128 - 1), st.sampled_from(list(Stream)), st.data())
def test_the_same_owner_gets_the_same_stream(seed, stage, data):
    owner = data.draw(st.tuples(*[KEYS] * OWNER_KEYS[stage]))
    assert first_draws(seed, stage, *owner) == first_draws(seed, stage, *owner)


def test_no_two_stages_or_owners_share_a_stream():
    streams = [
        first_draws(7, stage, *owner)
        for stage in Stream
        for owner in itertools.product((0, 1, 2, 20), repeat=OWNER_KEYS[stage])
    ]
    assert len(set(streams)) == len(streams)


@pytest.mark.parametrize("stage", list(Stream))
def test_seeds_give_different_streams(stage):
    owner = (0,) * OWNER_KEYS[stage]
    seeds = (0, 1, 2, 2**32, 2**32 + 1, 2**62)  # beyond 32 bits a seed spreads over two words
    assert len({first_draws(seed, stage, *owner) for seed in seeds}) == len(seeds)


def test_owners_beyond_32_bits_do_not_wrap():
    assert first_draws(7, Stream.GEARS, 5) != first_draws(7, Stream.GEARS, 2**32 + 5)


@pytest.mark.parametrize("stage", list(Stream))
def test_a_wrong_number_of_owner_keys_is_refused(stage):
    # (1,) and (1, 0) are different streams, so a forgotten key would pass unnoticed
    for count in (OWNER_KEYS[stage] - 1, OWNER_KEYS[stage] + 1):
        with pytest.raises(ValueError, match=stage.name):
            generator(7, stage, *(0,) * count)


def test_integers_of_stages_are_part_of_every_identity():
    assert {stage.name: int(stage) for stage in Stream} == {
        "SPLIT": 1,
        "GEARS": 2,
        "SUPPORTS": 3,
        "SENSOR": 4,
        "OPERATING_POINT": 5,
        "DAMAGED_TEETH": 6,
        "DAMAGE": 7,
        "START": 8,
        "NOISE": 9,
        "MANUFACTURE": 10,
        "DRIVE": 12,
        "BEARING_TONES": 14,
        "PATH": 11,
        "FORCE_NOISE": 13,
        "BACKGROUND": 15,
        "BACKGROUND_NOISE": 16,
        "PAIRS": 17,
        "PAIR_ORDER": 18,
        "LIFE": 19,
        "STREAM_ORDER": 20,
    }


def test_a_stream_is_the_one_that_existing_sets_were_made_with():
    # recorded once from this function; another value means that every existing set has become irreproducible
    assert generator(20260917, Stream.NOISE, 3, 2, 1, 0).random() == 0.14864908787470932


def test_a_named_stream_depends_on_its_name_alone_and_on_no_other_name():
    first, second = named_uniforms(7, Stream.GEARS, 3), named_uniforms(7, Stream.GEARS, 3)
    second("gears.module_mm")
    assert first("gears.face_width_mm") == second("gears.face_width_mm")
    assert first("gears.module_mm") != first("gears.face_width_mm")


def test_named_streams_meet_neither_each_other_nor_the_streams_of_owners():
    named = [named_generator(7, Stream.GEARS, i, name=n).random() for i in range(3) for n in ("a", "b", "a.b")]
    plain = [generator(7, Stream.GEARS, i).random() for i in range(3)]
    two_keys = [generator(7, Stream.OPERATING_POINT, i, j).random() for i in range(3) for j in range(3)]
    assert len({*named, *plain, *two_keys}) == 9 + 3 + 9


def test_a_named_stream_of_a_wrong_owner_is_refused():
    with pytest.raises(ValueError, match="GEARS"):
        named_generator(7, Stream.GEARS, 1, 2, name="a")
