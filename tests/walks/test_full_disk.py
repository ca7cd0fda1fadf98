"""Commands on a disk that takes no more: they say so, and leave nothing that is not whole."""

from __future__ import annotations

import os
import resource
import subprocess
from collections.abc import Callable, Iterator
from contextlib import chdir, contextmanager
from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.io import wavfile

from siggen.file_writing import LEFTOVER_SUFFIX
from tests.command import command
from tests.dataset.fake_set import write_fake_set
from tests.publication.conftest import FACTS
from tests.walks.walking import FS_HZ, recorded

PROGRAMS = {"siggen": "siggen", "siggen-diagnostics": "diagnostics"}
DESCRIBED = "--unit g --teeth 18,47 --speed-range 28,32"
LINES = {
    "init": "siggen init --teeth 18,47 --module 3 --speed 33,36 --torque 30,45 --sensors 1 --out DISK/rig.yaml",
    "modes": "siggen inspect modes quickstart --out DISK/modes.csv --png DISK/modes.png",
    "errors": "siggen inspect errors quickstart --out DISK/errors.parquet",
    "publish": "siggen publish set --to DISK/upload --facts publication.yaml",
    "baseline": f"siggen-diagnostics baseline april.wav may.wav june.wav july.wav {DESCRIBED} --out DISK/machine",
    "indicators": f"siggen-diagnostics indicators may.wav june.wav {DESCRIBED} --out DISK/indicators",
    "explore": f"siggen-diagnostics explore may.wav june.wav {DESCRIBED} --out DISK/look.html",
}


@pytest.fixture(scope="module")
def material(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a set of made-up records, the authors' facts and four recordings."""
    folder = tmp_path_factory.mktemp("material")
    write_fake_set(folder / "set")
    (folder / "publication.yaml").write_text(yaml.safe_dump(FACTS))
    for seed, name in enumerate(("april", "may", "june", "july")):
        wavfile.write(folder / f"{name}.wav", round(FS_HZ), recorded(seed, 0.0).astype(np.float32))
    return folder


@contextmanager
def full_disk(place: Path, free: int) -> Iterator[Callable[[], object]]:
    """Put a disk with so many free bytes in place; where none can be mounted, let no file grow beyond them.

    Yields what makes room.
    """
    place.mkdir()
    page = os.sysconf("SC_PAGE_SIZE")
    size = (free // page + 1) * page  # a size of 0 would be no limit: one page is filled instead
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    mounted = mount(f"size={size}", place)
    if mounted:
        (place / "filler").write_bytes(bytes(page))
    else:
        resource.setrlimit(resource.RLIMIT_FSIZE, (free, before[1]))
    try:
        yield lambda: mount("remount,size=100m", place) or resource.setrlimit(resource.RLIMIT_FSIZE, before)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        if mounted:
            subprocess.run(["umount", str(place)], check=True)


def mount(options: str, place: Path) -> bool:
    line = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(place)]
    return os.geteuid() == 0 and subprocess.run(line, check=False, capture_output=True).returncode == 0


def files(folder: Path) -> dict[str, int]:
    """Return name -> bytes of all files below a folder, hidden ones too."""
    paths = (path for path in folder.rglob("*") if path.is_file() and path.name != "filler")
    return {path.relative_to(folder).as_posix(): path.stat().st_size for path in paths}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", LINES)
def test_a_full_disk_is_told_and_holds_nothing_half_written(name: str, material: Path, tmp_path: Path) -> None:
    def run(disk: Path) -> tuple[int, str]:
        program, *words = LINES[name].replace("DISK", str(disk)).split()
        with chdir(material):
            done = command(PROGRAMS[program], *words)
        return done.returncode, done.stderr

    code, said = run(tmp_path / "roomy")
    assert code == 0, said
    whole = files(tmp_path / "roomy")
    assert whole
    largest = max(whole.values())
    for free in {0, largest // 2}:
        place = tmp_path / f"free_{free}"
        with full_disk(place, free) as make_room:
            code, said = run(place)
            left = files(place)
            assert code == 2, said
            assert "No space left on device" in said or "File too large" in said
            assert "unexpected" not in said
            assert not [file for file in left if file.endswith(LEFTOVER_SUFFIX)]
            assert left.items() <= whole.items()
            assert max(left.values(), default=0) <= free
            make_room()
            code, said = run(place)
            assert code == 0, said
            assert files(place) == whole
