"""Words that stand for numbers: of sections, of sensors, and what a file that extends another one changes of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from siggen.checks.loading import load_config
from siggen.config import Config, parse
from siggen.errors import ConfigError
from siggen.keys.catalogue import CATALOGUE
from tests.config.minimal import config, minimal

ON_HOUSING = {"place": "lid"}


def loaded(folder: Path, text: str, *overrides: str) -> Config:
    file = folder / "mine.yaml"
    file.write_text(f"extends: quickstart\nname: mine\n{text}")
    return load_config(file, overrides).config


@pytest.mark.parametrize("section", ["variation", "background"])
def test_a_word_stands_for_the_numbers_of_its_section(section: str) -> None:
    for word, entry in CATALOGUE[section].items():
        by_word, written = config(**{section: word}), config(**{section: entry.keys})
        assert by_word == written
        assert by_word.identity == written.identity
        assert parse(by_word.canonical()).config == written


def test_a_sensor_has_the_keys_of_its_model_and_its_mount_below_its_own() -> None:
    for model, of_model in CATALOGUE["model"].items():
        for mount, of_mount in CATALOGUE["mount"].items():
            own = {**ON_HOUSING, "range_m_s2": 77.0}
            made = config(sensors={"lid": {"model": model, "mount": mount, "mains": None, **own}})
            assert made == config(sensors={"lid": {**of_model.keys, **of_mount.keys, "mains": None, **own}})


def test_keys_beside_a_word_go_before_it_at_any_depth() -> None:
    made = config(variation={"like": "laboratory", "speed": {"slip": 0.02}}).variation
    plain = config(variation="laboratory").variation
    assert made.speed.slip == 0.02
    assert made.model_copy(update={"speed": made.speed.model_copy(update={"slip": 0.0})}) == plain


def test_a_file_changes_keys_of_a_word_that_it_extends_or_takes_another_one(tmp_path: Path) -> None:
    changed = loaded(tmp_path, "variation: {speed: {slip: 0.02}}\nsensors: {lid: {mount: magnet}}\n")
    assert changed.variation.speed.random_rms == config(variation="laboratory").variation.speed.random_rms
    assert changed.variation.speed.slip == 0.02
    assert changed.sensors[0].mounting == changed.sensors[1].mounting
    assert loaded(tmp_path, "variation: plant\nbackground: {machines: null}\n").background.machines is None
    assert loaded(tmp_path, "variation: plant\n").variation == config(variation="plant").variation
    assert loaded(tmp_path, "background: {like: laboratory}\n").background.second_stage is None


def test_a_key_below_a_word_is_set_from_the_command_line(tmp_path: Path) -> None:
    made = loaded(tmp_path, "", "variation.speed.slip=0.02", "sensors.lid.mount=magnet", "background.base=null")
    assert (made.variation.speed.slip, made.background.base) == (0.02, None)
    assert made.sensors[0].mounting == made.sensors[1].mounting


@pytest.mark.parametrize(
    ("changes", "path", "received", "allowed"),
    [
        ({"variation": "labratory"}, "variation.like", "'labratory'", "did you mean 'laboratory'"),
        ({"variation": 5}, "variation", "5", "a word of the catalogue, laboratory or plant"),
        ({"background": {"like": "plant"}}, "background.like", "'plant'", "one of laboratory"),
        ({"sensors": {"lid": {"mount": "stut"}}}, "sensors.lid.mount", "'stut'", "did you mean 'stud'"),
        ({"sensors": {"lid": {"model": ["shock"]}}}, "sensors.lid.model", "a list of 1", "laboratory, plant, shock"),
    ],
)
def test_a_word_that_no_catalogue_has_is_refused_with_those_that_it_has(changes, path, received, allowed) -> None:
    (problem,) = parse(minimal(**changes)).problems
    assert problem.path == path
    assert received in problem.received
    assert allowed in problem.allowed


def test_a_word_is_named_with_its_line(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"sensors\.lid\.model.*line 4"):
        loaded(tmp_path, "sensors:\n  lid: {model: shok}\n")
