"""A small benchmark of short records, made as a user makes one, with a secret that the tests know."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import pytest

import siggen
from diagnostics.bench.making import SIMULATED, Tier, commit_benchmark, write_benchmark
from diagnostics.scoring.benchmark import SEALED, Benchmark, open_benchmark
from tests.shared import shared_folder

SECRET = b"a secret of a test, which is long enough to be one"
PITS = {
    "kind": "clustered", "gear": "pinion", "teeth": 1, "count": 8, "centre_height_mm": "pitch",
    "spread_profile_mm": 0.3, "semi_axis_face_mm": 0.3, "semi_axis_profile_mm": 0.2, "depth_mm": 0.3,
}  # fmt: skip
CONFIG = {
    "extends": str(Path(__file__).parents[2] / "configs" / "linear_pits.yaml"),
    "fs_hz": 12_800,
    "duration_s": 0.3,
    "mesh_harmonics": 3,
    "operating_points": [
        {
            "speed_hz": [30, 35],
            "torque_nm": [30, 60],
        }
    ],
    "states": {
        "others": None,
        "healthy": {},
        "healthy_again": {},
        "pits": {"severity": "slight", "damage": PITS},
        "sham": {"acts": False, "damage": PITS},
    },
}
OTHERS = {
    "other_fault": {
        "states": {"healthy": {}, "healthy_again": {}, "many": {"severity": "slight", "damage": PITS | {"count": 20}}}
    }
}
GEARBOXES = 14
SMALL = Tier(2, 2)


class Made(NamedTuple):
    """A benchmark, and the folder of what is secret."""

    benchmark: Benchmark
    hidden: Path

    @property
    def sealed(self) -> Path:
        return self.hidden / SEALED

    def simulated(self, part: str) -> Path:
        return self.hidden / SIMULATED / part


def make(folder: Path, size: Tier = SMALL, secret: bytes = SECRET, facts: Path | None = None) -> Made:
    """Make a benchmark; without an argument a small one of one test part, in which attackers would see nothing."""
    conditions: dict[str, Any] = {"same": {}, **(OTHERS if size != SMALL else {})}
    learn, hidden = siggen.load_config(CONFIG, [f"specimens={size.learn}"]), folder / "hidden"
    facts_of = {"conditions": conditions, "facts": facts, "workers": 0}
    return Made(write_benchmark(folder / "bench", hidden, secret, learn, "tiny", size.test, **facts_of), hidden)


def committed_benchmark(factory: pytest.TempPathFactory) -> Path:
    """Return a folder with `bench`, committed to, and `hidden`; files copy what they change."""

    def committed(folder: Path) -> None:
        found = make(folder, Tier(6, GEARBOXES))
        commit_benchmark(found.benchmark.path, found.sealed)

    return shared_folder(factory, "benchmark", committed)


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    """The committed benchmark."""
    folder = committed_benchmark(tmp_path_factory)
    return Made(open_benchmark(folder / "bench"), folder / "hidden")
