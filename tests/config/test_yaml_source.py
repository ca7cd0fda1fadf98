"""Reading YAML: numbers as an engineer writes them, no key twice, and the line where it goes wrong."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.config import parse_yaml, read_yaml, yaml_text
from siggen.errors import ConfigError, UsageError


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e3", 1000.0),
        ("1E3", 1000.0),
        ("2.06e11", 2.06e11),
        ("2.06e+11", 2.06e11),
        ("5e-5", 5e-5),
        (".5", 0.5),
        ("-3.", -3.0),
        ("51200", 51200),
        ("010", 10),  # eight in YAML 1.1
        ("+7", 7),
        ("30:20", "30:20"),  # 1820 in YAML 1.1
        ("1_000", "1_000"),  # 1000 in YAML 1.1
        ("no", "no"),  # false in YAML 1.1
        ("on", "on"),
        ("true", True),
        ("2026-09-17", "2026-09-17"),  # a date in YAML 1.1
        ("null", None),
        ("~", None),
        ("", None),
        ("8dof", "8dof"),
        ("'3'", "3"),
        ("e3", "e3"),
        (".", "."),
    ],
)
def test_scalars_follow_yaml_1_2(text, value):
    found = parse_yaml(f"x: {text}")["x"]
    assert found == value
    assert type(found) is type(value)


def test_infinity_and_nan_are_floats_that_checks_can_refuse():
    assert parse_yaml("x: -.inf")["x"] == -math.inf
    assert math.isnan(parse_yaml("x: .nan")["x"])


def test_a_key_given_twice_is_refused_with_both_lines():
    with pytest.raises(ConfigError) as caught:
        parse_yaml("a: 1\nb:\n  c: 1\n  d: 2\n  c: 3\na: 2\n")
    assert [problem.path for problem in caught.value.problems] == ["line 5", "line 6"]
    assert "'c'" in str(caught.value)
    assert "first on line 3" in str(caught.value)
    assert "first on line 1" in str(caught.value)


def test_the_same_key_in_different_mappings_is_no_problem():
    assert parse_yaml("a: {x: 1}\nb: {x: 2}") == {"a": {"x": 1}, "b": {"x": 2}}


def test_merged_mappings_may_be_overridden():
    raw = parse_yaml("a: &a {x: 1, y: 2}\nb: &b {<<: *a, y: 3}\nc: {<<: *b, z: 4}")
    assert raw["b"] == {"x": 1, "y": 3}
    assert raw["c"] == {"x": 1, "y": 3, "z": 4}


@pytest.mark.parametrize("key", ["1", "1.5", "true", "null", "[a]", "{a: 1}"])
def test_keys_that_are_no_texts_are_refused(key):
    with pytest.raises(ConfigError, match="keys that are texts"):
        parse_yaml(f"? {key}\n: 1\n")


@pytest.mark.parametrize(
    ("text", "line", "hint"),
    [
        ("a: 1\nb: [1, 2\nc: 3", "line 3", "valid YAML"),
        ("a: 1\n\tb: 2", "line 2", "spaces"),
        ("a: *unknown", "line 1", "valid YAML"),
        ("a: 1\n---\nb: 2", "line 2", "valid YAML"),
        ("a: !!python/object/apply:os.getcwd []", "line 1", "without tags"),
    ],
)
def test_what_is_no_yaml_is_refused_with_its_line(text, line, hint):
    with pytest.raises(ConfigError) as caught:
        parse_yaml(text)
    (problem,) = caught.value.problems
    assert problem.path.startswith(line)
    assert hint in problem.allowed


@pytest.mark.parametrize(("text", "received"), [("", "empty"), ("- 1\n- 2", "list"), ("hello", "str")])
def test_what_is_no_mapping_is_refused(text, received):
    with pytest.raises(ConfigError, match=received):
        parse_yaml(text)


def test_files_that_cannot_be_read_are_refused_by_name(tmp_path):
    binary = tmp_path / "binary.yaml"
    binary.write_bytes(b"\xff\xfe\x00")
    for path in (tmp_path / "missing.yaml", tmp_path, binary):
        with pytest.raises(UsageError, match=path.name):
            read_yaml(path)


SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(allow_nan=False),
    st.text(max_size=8),
    st.sampled_from(["1e3", "no", "010", "~", "", "30:20"]),
)


@given(st.dictionaries(st.text(min_size=1, max_size=8), st.one_of(SCALARS, st.lists(SCALARS, max_size=3)), min_size=1))
def test_what_is_written_is_read_back(mapping):
    assert parse_yaml(yaml_text(mapping)) == mapping
