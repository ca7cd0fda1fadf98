"""Identity of a configuration: unaffected by how it is written and by its number of specimens, and by nothing else."""

from __future__ import annotations

import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.config import Config, parse, parse_yaml, yaml_text
from tests.config.minimal import MINIMAL, config, minimal


def reordered(value):
    """Return a value with the keys of all its mappings the other way round."""
    if isinstance(value, dict):
        return {key: reordered(value[key]) for key in reversed(value)}
    return [reordered(item) for item in value] if isinstance(value, list) else value


@given(st.integers(1, 10**7))
def test_more_specimens_are_the_same_set(specimens):
    assert config(specimens=specimens).identity == config().identity


def test_order_of_keys_does_not_matter():
    parsed = parse({**reordered(minimal()), "states": minimal()["states"]})  # whose order is that of the records
    assert parsed.config is not None
    assert parsed.config == config()
    assert parsed.config.identity == config().identity


@pytest.mark.parametrize("text", ["30", "30.0", "3e1", "3.0e+1", "30."])
def test_formatting_of_a_number_does_not_matter(text):
    raw = minimal(operating_points__0__speed_hz=parse_yaml(f"x: {text}")["x"])
    assert parse(raw).config.identity == config().identity


def test_minus_zero_is_zero():
    assert config(gears__pinion__profile_shift=-0.0).identity == config().identity


def test_a_default_that_is_written_out_does_not_matter():
    assert config(dynamics__backlash_um=80.0, repeats=1, states__slight__fault="pitting").identity == config().identity


CHANGES = [
    ("name", "other"),
    ("seed", 8),
    ("fs_hz", 25_600),
    ("duration_s", 2),
    ("mesh_harmonics", 4),
    ("repeats", 2),
    ("splits", {"train": 10, "validation": 5, "test": 5}),
    ("gears__module_mm", 3.5),
    ("gears__module_mm", [3, 3.5]),
    ("gears__gear__teeth", 48),
    ("stiffness__beam", "base_circle"),
    ("dynamics__model", "8dof"),
    ("dynamics__pinion__mass_kg", 0.4),
    ("operating_points__0__torque_nm", 61),
    ("states", {"healthy": {}, "mild": {**MINIMAL["states"]["slight"], "severity": "slight"}}),
    ("states__slight__damage__depth_mm", 0.41),
    ("states__slight__severity", "first"),
    ("sensors__bearing__bits", None),
    ("sensors__bearing__noise", {"floor_m_s2": 20}),
    ("sensors__bearing__axes", ["horizontal"]),
]


def test_everything_else_changes_the_identity():
    identities = [config().identity, *(config(**{path: value}).identity for path, value in CHANGES)]
    assert len(set(identities)) == len(identities)


@pytest.mark.parametrize(("path", "value"), [*CHANGES[:14], *CHANGES[16:]])
def test_the_canonical_form_gives_an_equal_configuration(path, value):
    made = config(**{path: value})
    again = parse(made.canonical())
    assert again.config == made
    assert again.config.identity == made.identity


def test_the_written_file_gives_an_equal_configuration_and_the_same_bytes():
    first = config(name="1e3", gears__module_mm={"normal": [3, 1e-9], "within": [2, 4]})
    text = yaml_text(first.canonical())
    again = parse(parse_yaml(text)).config
    assert again == first
    assert yaml_text(again.canonical()) == text


def test_a_configuration_cannot_be_changed_and_travels_between_processes():
    first = config()
    with pytest.raises(Exception, match="frozen"):
        first.seed = 3  # type: ignore[misc]
    travelled = pickle.loads(pickle.dumps(first))
    assert travelled == first
    assert hash(travelled) == hash(first)
    assert isinstance(travelled, Config)


def test_a_key_at_its_default_does_not_count_wherever_it_stands():
    class Longer(Config):
        manufacturing: float | None = None

    assert Longer.model_validate(dict(config())).identity == config().identity
    assert Longer.model_validate({**dict(config()), "manufacturing": 6.0}).identity != config().identity
