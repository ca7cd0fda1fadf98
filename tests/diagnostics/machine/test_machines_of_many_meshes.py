"""Machines with several meshes against their healthy recordings, by command, on signals that are made here."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from diagnostics.cli.app import app
from diagnostics.recordings.configured_train import configured_train
from diagnostics.records.gear_train import PAIR, gear_names, meshes_of
from siggen.errors import SiggenError
from tests.config.mill import mill
from tests.config.planets import planets
from tests.config.staged import staged
from tests.rig_file import rig_file

FS_HZ, SECONDS = 8000.0, 4.0
CHANGED = 4
"""Exit code."""


def run(*arguments: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)
    return result.exit_code, result.output


def knock(turn: np.ndarray) -> np.ndarray:
    """Return one knock per turn."""
    phase = turn % 1.0
    return np.asarray(np.exp(-phase / 0.01) * np.sin(2.0 * np.pi * 90.0 * phase))


def of_stages(turn: np.ndarray, level: float) -> np.ndarray:
    """Return lines of 18 and of 17 teeth over turns of the first pinion; a tooth of the second pinion knocks."""
    behind = turn * 18 / 47
    return np.asarray(np.cos(2 * np.pi * 18 * turn) + np.cos(2 * np.pi * 17 * behind) + level * knock(behind))


def of_planets(turn: np.ndarray, level: float) -> np.ndarray:
    """Return forces of three planets along one direction over turns of the sun's shaft; a tooth of the sun knocks."""
    carrier, found = turn * 25 / 102, np.zeros(turn.size)
    for place in np.arange(3) / 3:
        met = turn * 77 / 102 - place
        found += np.cos(2 * np.pi * (carrier + place)) * (np.cos(2 * np.pi * 25 * met) + level * knock(met))
    return found


def recording(file: Path, made: Callable[..., np.ndarray], seed: int, level: float = 0.0) -> Path:
    rng = np.random.default_rng(seed)
    speed_hz, start = 25.0 * (1.0 + 1e-3 * rng.normal()), rng.uniform(0.0, 50.0)
    turn = speed_hz * np.arange(round(SECONDS * FS_HZ)) / FS_HZ + start
    pulses = (np.arange(np.ceil(turn[0]), turn[-1]) - start) / speed_hz
    np.savez(file, lid=made(turn, level) + 0.1 * rng.normal(size=turn.size), tacho_s=pulses)
    return file


@pytest.mark.parametrize(
    ("made", "config", "shaft", "named"),
    [(of_stages, staged, "pinion", "(?<!slow)_gear|slow_pinion"), (of_planets, planets, "sun", "_sun")],
)
def test_a_knock_is_named_by_the_shaft_that_has_it(
    tmp_path: Path, made: Callable[..., np.ndarray], config: Callable[[], dict[str, Any]], shaft: str, named: str
) -> None:
    """The gear in front and the second pinion stand on one shaft: both have the knock once per turn."""
    (tmp_path / "gearbox.yaml").write_text(yaml.safe_dump(config(), sort_keys=False), encoding="utf-8")
    files = [recording(tmp_path / f"healthy_{k}.npz", made, seed=k) for k in range(8)]
    facts = ("--fs", FS_HZ, *rig_file(tmp_path, tacho="tacho_s", teeth="gearbox.yaml"))
    code, said = run("baseline", *files, *facts, "--out", tmp_path / "rig")
    assert code == 0, said
    assert f"8 recordings, 1 channels, {shaft} at 24.9" in said
    again = recording(tmp_path / "again.npz", made, seed=50)
    knocks = recording(tmp_path / "knocks.npz", made, seed=51, level=3.0)
    code, said = run("check", tmp_path / "rig", again, knocks, "--json")
    assert code == CHANGED
    healthy, damaged = json.loads(said[said.index("{") : said.rindex("}") + 1])["checks"]
    assert damaged["score"]["score"] > 2.0 * healthy["score"]["score"]
    assert [bool(re.search(named, one["indicator"])) for one in damaged["moved"]] == [True] * 8, damaged["moved"]


def test_a_machine_in_own_names_has_the_meshes_of_its_short_form(tmp_path: Path) -> None:
    own, short = tmp_path / "mill.yaml", tmp_path / "staged.yaml"
    own.write_text(yaml.safe_dump(mill(), sort_keys=False), encoding="utf-8")
    short.write_text(yaml.safe_dump(staged(), sort_keys=False), encoding="utf-8")
    named, plain = (
        [replace(mesh, names=PAIR[0]) for mesh in meshes_of(configured_train(file))] for file in (own, short)
    )
    assert named == plain
    assert [mesh.name for mesh in gear_names(configured_train(own))] == ["fast", "slow"]


def test_planets_need_a_tacho(tmp_path: Path) -> None:
    file = recording(tmp_path / "one.npz", of_planets, seed=1)
    (tmp_path / "gearbox.yaml").write_text(yaml.safe_dump(planets(), sort_keys=False), encoding="utf-8")
    told = ("--fs", FS_HZ, "--teeth", tmp_path / "gearbox.yaml", "--out", tmp_path / "out")
    with pytest.raises(SiggenError, match="no tacho; the speed of planetary sets"):
        run("indicators", file, *told, *rig_file(tmp_path, unit="m/s2", channels={"lid": "lid"}), "--speed", "20,30")
    code, said = run("indicators", file, *told, *rig_file(tmp_path, unit="m/s2", tacho="tacho_s"))
    assert code == 0, said
    assert "sun 25.0" in said
    assert (tmp_path / "out/indicators.csv").read_text(encoding="utf-8").count("fm4_planet") == 1
