"""Lines of keys: every problem of a configuration names the line, or the override, that its value comes from."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from siggen.checks.loading import load_config
from siggen.config import read_yaml
from siggen.config.key_lines import key_line
from siggen.errors import ConfigError
from siggen.keys.yaml_source import yaml_node

CONFIGS = sorted((Path(__file__).resolve().parents[2] / "configs").glob("*.yaml"))
BENCH = Path(__file__).resolve().parents[2] / "configs" / "bench.yaml"


def keys(value: object, path: str = "") -> Iterator[tuple[str, str]]:
    """Yield path and last key of everything below a value."""
    entries = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in entries:
        below = f"{path}.{key}".removeprefix(".")
        if isinstance(key, str):
            yield below, key
        yield from keys(item, below)


@pytest.mark.parametrize("file", CONFIGS, ids=lambda file: file.stem)
def test_every_key_of_a_shipped_file_stands_on_its_line(file: Path) -> None:
    text = file.read_text()
    node, lines = yaml_node(text), text.splitlines()
    for path, key in keys(read_yaml(file)):
        found = key_line(node, path)
        assert found is not None, path
        assert found.depth == len(path.split("."))
        assert f"{key}:" in lines[found.line - 1].replace('"', ""), (path, found)


def test_a_missing_key_has_the_line_of_what_misses_it_and_merges_end() -> None:
    text = "gears:\n  pinion: {teeth: 18}\nstates:\n  a: &a {sham: true}\n  b:\n    <<: *a\n    damage: null\n"
    node = yaml_node(text)
    assert key_line(node, "gears.pinion.bore_radius_mm") == (2, 2, False)
    assert key_line(node, "states.b.sham") == (4, 3, True)
    assert key_line(node, "states.b.damage") == (7, 3, True)
    assert key_line(node, "dynamics.mesh") is None
    # a mapping that merges itself is refused before anybody asks for its lines
    assert yaml_node("a: &a {<<: *a, b: 1}\n") is None
    assert key_line(yaml_node("{"), "a") is None


def test_a_key_of_an_extended_file_is_found_there_unless_a_list_or_kind_replaces_it(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text(BENCH.read_text().replace("module_mm:", "modul_mm:", 1))
    own = tmp_path / "own.yaml"
    own.write_text("extends: base.yaml\nname: own\nsensors:\n  lid: {axes: [vertical], place: x}\nmesh_harmonics: 0\n")
    with pytest.raises(ConfigError) as refused:
        load_config(own)
    found = {problem.path: problem.where for problem in refused.value.problems}
    line = next(i for i, text in enumerate((tmp_path / "base.yaml").read_text().splitlines(), 1) if "modul_mm:" in text)
    assert found["gears.modul_mm"] == f"line {line} of base.yaml, which this file extends"
    assert found["mesh_harmonics"] == "line 5"
    assert found["sensors.lid.place"] == "line 4"


# what is written in place of what; key, and what is said
BAD = [
    ("      bearing_span_mm: ", "      bearing_span_mm: 0.0 #", "dynamics.shafts.driver.bearing_span_mm"),
    ("  lead_misalignment_um: ", "  lead_misalignment_um: 1e6 #", "manufacture.lead_misalignment_um"),
    ("  crowning_um: ", "  crowning_um: -1 #", "manufacture.crowning_um"),
    ("  like: laboratory\n", "  like: laboratory\n  machines: {density_n_per_sqrt_hz: 1e9}\n",
     "background.machines.density_n_per_sqrt_hz"),
    ("states:\n", "states:\n  x: {severity: slight, damage: {kind: irregular, profile_length_mm: 0.2, "
     "face_share: 1.0, skew_mm_per_10mm: [-2, 2]}}\n", "states.x.damage.skew_mm_per_10mm"),
    ("states:\n", "states:\n  x: {severity: slight, damage: {kind: irregular, profile_length_mm: 9, "
     "face_share: 1.0}}\n", "states.x.damage.profile_length_mm"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "path"), BAD, ids=[one[2] for one in BAD])
def test_a_problem_names_key_value_range_and_line(old: str, new: str, path: str, tmp_path: Path) -> None:
    text = BENCH.read_text().replace(f"\n{old}", f"\n{new}", 1)
    file = tmp_path / "set.yaml"
    file.write_text(text)
    with pytest.raises(ConfigError) as refused:
        load_config(file)
    (found,) = [one for one in refused.value.problems if one.path == path]
    line = int(found.where.removeprefix("line "))
    assert path.rpartition(".")[2] in text.splitlines()[line - 1]
    assert "allowed: " in found.allowed
    assert str(found).endswith(f"(line {line})")


def test_a_value_from_an_override_names_the_override_and_not_the_file() -> None:
    with pytest.raises(ConfigError, match=r"gears.module_mm: received -3.0; .* \(--set gears.module_mm\)"):
        load_config(BENCH, ["gears.module_mm=4", "gears.module_mm=-3"])
    with pytest.raises(ConfigError, match=r"gears.pinion.teeth: received .* \(--set gears.pinion\)"):
        load_config(BENCH, ["gears.pinion={teeth: 1, bore_radius_mm: 5}"])


def test_a_value_that_a_state_takes_over_from_an_override_names_the_override() -> None:
    with pytest.raises(ConfigError) as refused:
        load_config("quickstart", ["states.slight.damage.depth_mm=9"])
    found = {one.path: one.where for one in refused.value.problems}
    assert {*found} == {f"states.{state}.damage.depth_mm" for state in ("slight", "moderate", "severe", "sham")}
    assert {*found.values()} == {"--set states.slight.damage.depth_mm"}
    # a key of its own in the file goes first: of 20 mm the spall of 16 mm ends at 21, those of 4 and 8 mm on the face
    with pytest.raises(ConfigError, match=r"states.severe.damage.face_share: .* \(line \d+\)"):
        load_config("quickstart", ["states.slight.damage.face_centre_mm=13"])


def test_a_line_beside_which_an_override_changed_something_names_both() -> None:
    with pytest.raises(
        ConfigError, match=r"planetary.positions_deg: .* \(line \d+, beside --set planetary.ring_teeth\)"
    ):
        load_config("planetary", ["planetary.ring_teeth=78"])
