"""A small set, published, and what siggen reads of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import siggen
from siggen.checks.loading import load_config
from siggen.publication.publish import publish

CONFIG = Path(__file__).with_name("two_gearboxes.yaml")
SIGNAL = "accel_lid_vertical_m_s2"
FACTS: dict[str, Any] = {
    "license": "cc-by-4.0",
    "title": "Two gearboxes",
    "version": "1.0.0",
    "published": "2026-11-30",
    "publisher": "Zenodo",
    "url": "https://example.org/two",
    "citation": "Author, A. (2026). Two gearboxes.",
    "authors": [{"name": "Author, An", "orcid": "0000-0002-1825-0097", "affiliation": "An institute"}],
}


def facts_file(folder: Path, **changes: Any) -> Path:
    path = folder / "publication.yaml"
    path.write_text(yaml.safe_dump({**FACTS, **changes}))
    return path


@pytest.fixture(scope="session")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a set that grew once."""
    folder = tmp_path_factory.mktemp("kept")
    siggen.generate(load_config(CONFIG, ["specimens=1"]), folder / "set", executor="serial")
    siggen.generate(load_config(CONFIG, ["specimens=2"]), folder / "set", executor="serial")
    return folder / "set"


@pytest.fixture(scope="module")
def published(kept: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("published")
    publish(kept, folder / "set", facts_file(folder))
    return folder / "set"


@pytest.fixture(scope="module")
def expected(kept: Path) -> dict[str, Any]:
    """Return what siggen reads of the set itself: signals (n, samples), record ids, states."""
    records = [siggen.open(kept).record(i) for i in range(4)]
    return {
        "signals": np.stack([record[SIGNAL] for record in records]),
        "state": [record["state"] for record in records],
        "tacho_s": [record["tacho_s"].tolist() for record in records],
        "speed_hz": [record["speed_hz"] for record in records],
    }
