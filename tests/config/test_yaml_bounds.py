"""What YAML allows and a configuration does not: refused at once, in words, with the line."""

from __future__ import annotations

import time
import tracemalloc
from pathlib import Path

import pytest

from siggen.config import STORED_NUMBERS, parse, parse_yaml, read_yaml
from siggen.errors import ConfigError, UsageError
from tests.config.minimal import minimal

LAUGHS = "a0: &a0 [ha, ha]\n" + "".join(f"a{i}: &a{i} [*a{i - 1}, *a{i - 1}]\n" for i in range(1, 40))
MERGES = "a0: &a0 {x: 1}\n" + "".join(f"a{i}: &a{i} {{<<: [*a{i - 1}, *a{i - 1}], k{i}: 1}}\n" for i in range(1, 40))
HOSTILE = {
    "a billion laughs": (LAUGHS, "line 1[0-9]", "values, those repeated by aliases counted again"),
    "a billion merges": (MERGES, "line 1[0-9]", "values, those repeated by aliases counted again"),
    "nested lists": ("a: 1\nb: " + "[" * 5000, "line 2", "mappings or lists within each other"),
    "nested mappings": ("a: " + "{a: " * 5000, "line 1", "mappings or lists within each other"),
    "nested dashes": ("- " * 5000, "line 1", "mappings or lists within each other"),
    "nested through aliases": (
        "a: &a " + "[" * 20 + "]" * 20 + "\nb: &b " + "[" * 10 + "*a" + "]" * 10 + "\nc:\n - " + "[" * 8 + "*b",
        "line 4", "mappings or lists within each other",
    ),
    "a list in itself": ("a: 1\nb: &b [1, *b]\n", "line 2", "an alias of the mapping or list that it stands in"),
    "a mapping merged into itself": ("a: &a\n  <<: *a\n", "line 2", "an alias of the mapping"),
    "code": ("a: 1\nb: !!python/object/apply:os.getcwd []\n", "line 2", "the tag tag:yaml.org,2002:python/object"),
    "a number that is none": ("a: !!int x\n", "line 1", "the tag tag:yaml.org,2002:int"),
    "a tag of one's own": ("a: !mine 3\n", "line 1", "the tag !mine"),
    "an empty tag": ("a: ! 3\n", "line 1", "the tag !"),
    "a character": ("a: 1\nb: \x07\n", "line 2", "the character #x0007"),
    "nothing": ("", "line 1", "an empty file"),
    "a text": ("hello", "line 1", "str at the top"),
}  # fmt: skip


@pytest.mark.parametrize("what", HOSTILE)
def test_a_hostile_text_is_refused_with_its_line_within_bounds_of_time_and_memory(what: str) -> None:
    text, line, received = HOSTILE[what]
    started_s = time.process_time()
    tracemalloc.start()
    try:
        with pytest.raises(ConfigError, match=rf"{line}.*: received .*{received}"):
            parse_yaml(text)
        assert tracemalloc.get_traced_memory()[1] < 50e6
    finally:
        tracemalloc.stop()
    # the whole command has 2 s; tracing makes this ten times slower than it is
    assert time.process_time() - started_s < 20.0


def test_numbers_in_lists_are_counted_apart_and_a_set_may_store_more() -> None:
    text = f"a: [{'1.5, ' * 25_000}-2e-3, 7]\n"
    assert parse_yaml(text)["a"][-3:] == [1.5, -2e-3, 7]
    twice = f"a: &a [{'1.5, ' * 25_000}1]\nb: [{'1.5, ' * 25_000}1]\n"
    with pytest.raises(ConfigError, match="line 2: received 30001 numbers in lists; allowed: at most 30000"):
        parse_yaml(twice)
    assert len(parse_yaml(twice, most_numbers=STORED_NUMBERS)["b"]) == 25_001
    with pytest.raises(ConfigError, match="line 2: received 25006 values, those repeated by aliases counted again"):
        parse_yaml(f"a: &a [{'1.5, ' * 25_000}1]\nb: *a\n")


def test_a_section_of_more_entries_than_anybody_lists_is_refused_at_once() -> None:
    problems = parse(minimal(operating_points=[1.5] * 20_000)).problems
    assert [(p.path, p.received) for p in problems] == [("operating_points", "a list of 20000")]
    assert len(parse(minimal(states={f"state_{i}": {"a": 1} for i in range(4_000)})).problems) < 1_100


def test_aliases_and_merges_of_a_useful_size_stay_allowed() -> None:
    text = "one: &one {kind: ellipse, depth_mm: 0.4}\n" + "".join(f"s{i}: {{<<: *one, n: {i}}}\n" for i in range(500))
    assert parse_yaml(text)["s499"] == {"kind": "ellipse", "depth_mm": 0.4, "n": 499}


def test_a_file_that_is_too_large_or_never_ends_is_refused(tmp_path: Path) -> None:
    (tmp_path / "long.yaml").write_text("# a comment\n" * 400_000)
    endless = Path("/dev/zero")
    for path in (tmp_path / "long.yaml", *([endless] if endless.exists() else [])):
        with pytest.raises(ConfigError, match=r"line .*: received more than 4194304 bytes"):
            read_yaml(path)


def test_text_in_another_encoding_is_refused_with_its_line(tmp_path: Path) -> None:
    (tmp_path / "latin.yaml").write_bytes("name: a\n# Größe\n".encode("latin-1"))
    with pytest.raises(UsageError, match=r"no text in UTF-8 \(line 2\)"):
        read_yaml(tmp_path / "latin.yaml")


@pytest.mark.parametrize("section", [None, "gears"])
def test_of_many_unknown_keys_ten_are_named_and_the_others_counted(section: str | None) -> None:
    raw = minimal()
    target = raw if section is None else raw[section]
    target |= {f"colour_{i}": 3 for i in range(2000)}
    problems = parse(raw).problems
    assert [p.allowed.startswith("there is no such key here") for p in problems] == [True] * 10 + [False]
    assert problems[-1].received == "1990 more unknown keys"
    assert problems[-1].path.endswith("colour_10")


def test_of_many_problems_a_hundred_are_told_and_the_others_counted() -> None:
    raw = minimal(operating_points=[{"speed_hz": -1.0, "torque_nm": 3.0}] * 500)
    problems = parse(raw).problems
    assert len(problems) == 500
    lines = str(ConfigError(problems)).splitlines()
    assert len(lines) == 102
    assert lines[-1] == "  and 400 more"


@pytest.mark.parametrize("key", ["repeats", "specimens"])
def test_counts_beyond_what_a_set_can_hold_are_refused(key: str) -> None:
    for value in (10**8, 10**30, 10**390):
        (problem,) = parse(minimal(**{key: value})).problems
        assert problem.path == key
