"""A small planetary set by command: trained on and looked at; which member's indicators a spall moves.

Slow: twelve records of two seconds are simulated.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import yaml

from tests.config.minimal import by_name
from tests.config.planets import planets

pytestmark = pytest.mark.slow

MEMBERS = ("sun", "planet")


def run(app: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", f"from {app}.cli.app import main; main()", *arguments],
        capture_output=True,
        text=True,
        check=False,
        timeout=500,
    )


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a set of four gearboxes in three states, twelve turns of the carrier, and its report."""
    folder = tmp_path_factory.mktemp("planets")
    sensors = [{"name": "ring", "place": "ring", "axes": ["horizontal"], "noise": {"floor_m_s2": 0.5}}]
    split = {"train": 10, "validation": 5, "test": 5}
    raw = planets(specimens=4, fs_hz=12_800.0, duration_s=2.0, sensors=by_name(sensors), splits=split)
    (folder / "set.yaml").write_text(yaml.safe_dump(raw, sort_keys=False), encoding="utf-8")
    done = run("siggen", "generate", str(folder / "set.yaml"), "--out", str(folder / "set"), "--executor", "serial")
    assert done.returncode == 0, done.stdout + done.stderr
    done = run("diagnostics", "report", str(folder / "set"), "--out", str(folder / "report"), "--no-cnn")
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.fixture(scope="module")
def features(made: Path) -> pa.Table:
    return pq.read_table(made / "report/features.parquet")


def medians(features: pa.Table, indicator: str) -> dict[str, float]:
    states, values = np.array(features["state"].to_pylist()), features[f"{indicator}__ring_horizontal"].to_numpy()
    return {state: float(np.median(values[states == state])) for state in ("healthy", *MEMBERS)}


@pytest.mark.parametrize("indicator", ["fm4", "m6a", "average_kurtosis"])
@pytest.mark.parametrize("member", MEMBERS)
def test_a_spall_moves_the_indicators_of_its_member_and_not_of_the_other(
    features: pa.Table, member: str, indicator: str
) -> None:
    """One knock per turn makes an average peaked; what leaks of another member has no place in a turn.

    The factor over the healthy set is at least five, and three times that of the other member.
    """
    (other,) = set(MEMBERS) - {member}
    mine, others = (medians(features, f"{indicator}_{each}") for each in (member, other))
    factor = mine[member] / mine["healthy"]
    assert factor > 5.0
    assert factor > 3.0 * others[member] / others["healthy"]


def test_pages_and_tables_name_members_and_never_a_pair(made: Path, features: pa.Table) -> None:
    assert {"teeth_sun", "teeth_ring", "revolutions_sun", "revolutions_ring"} <= set(features.column_names)
    assert not [name for name in features.column_names if "pinion" in name or "gear" in name]
    assert np.isnan(features["sideband_sun_h1_upper1__ring_horizontal"].to_numpy()).all()  # 11 turns of 17
    assert "1 (needs 17)" in features["notes"][0].as_py()
    names = json.loads((made / "report/models/feature_names.json").read_text(encoding="utf-8"))
    assert "fm4_planet__ring_horizontal" in json.dumps(names)
    page = (made / "report/report.html").read_text(encoding="utf-8")
    assert '"gears":["sun","planet","ring"],"planetary":true' in page  # so orders are of a turn against the carrier


def test_models_of_planetary_sets_judge_sets_and_no_recordings(made: Path) -> None:
    record = made / "record.csv"  # says no unit, and no teeth are given: neither would help
    record.write_text("ring_horizontal\n" + "\n".join(str(k % 7) for k in range(20_000)), encoding="utf-8")
    told = run("diagnostics", "predict", str(made / "report"), str(record), "--fs", "25600")
    assert told.returncode == 2
    assert "planetary sets with sun, planet, ring" in told.stderr
    assert "Traceback" not in told.stderr
