"""Commands on a disk that takes no more: they say so, and leave nothing that is not whole."""

from __future__ import annotations

import os
import resource
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest

from siggen.file_writing import LEFTOVER_SUFFIX
from tests.walks.lines import LINES, lay, lines
from tests.walks.walking import run

WRITERS = [name for name, line in LINES.items() if line.writes]
QUICK = {
    *("siggen generate", "siggen show", "siggen inspect flank"),
    *("siggen-diagnostics score", "siggen-diagnostics explore"),
}
"""Sets, tables, pictures, pages: each kind of file once."""
RUN_FILES = {"audit.json"}
"""They tell times, so their sizes differ from run to run."""
KEPT = "_table/"
"""Tables of indicators beside a set: where they do not fit, a command computes without them and says so."""


@contextmanager
def full_disk(place: Path, free: int, fill: Callable[[], object]) -> Iterator[Callable[[], object]]:
    """Put a disk in place that has so many bytes free once it is filled; else let no file grow beyond them.

    Yields what makes room.
    """
    place.mkdir()
    page = os.sysconf("SC_PAGE_SIZE")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    mounted = mount("size=100m", place)
    fill()
    if mounted:
        (place / "filler").write_bytes(bytes(page))  # a size of 0 would be no limit
        used = os.statvfs(place)
        mount(f"remount,size={((used.f_blocks - used.f_bfree) + free // page) * page}", place)
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


def settled_files(folder: Path) -> dict[str, int]:
    return {file: size for file, size in files(folder).items() if Path(file).name not in RUN_FILES}


def files(folder: Path) -> dict[str, int]:
    """Return name -> bytes of all files below a folder, hidden ones too."""
    paths = (path for path in folder.rglob("*") if path.is_file() and path.name != "filler")
    return {path.relative_to(folder).as_posix(): path.stat().st_size for path in paths}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", lines(WRITERS, QUICK))
def test_a_full_disk_is_told_and_holds_nothing_half_written(
    name: str, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    line, material, roomy = LINES[name], tmp_path / "material", tmp_path / "roomy"
    material.mkdir()
    roomy.mkdir()
    lay(material, line.words, tmp_path_factory)

    def said_by(disk: Path) -> tuple[int, str]:
        words = (
            line.words.replace("OUT/", f"{disk}/").replace("IN/", f"{disk}/").replace(" --workers 1", " --workers 0")
        )
        done = run(material, f"{name} {words}")
        return done.returncode, done.stderr

    def put(place: Path) -> None:
        lay(place, " ".join(word for word in line.words.split() if word.startswith("IN/")), tmp_path_factory)

    put(roomy)
    before = files(roomy)
    code, said = said_by(roomy)
    assert code == line.code, said
    whole = files(roomy)
    written = {file: size for file, size in whole.items() if before.get(file) != size}
    assert written
    needed = [size for file, size in written.items() if KEPT not in file]
    for free in {0, max(needed) // 2}:
        place = tmp_path / f"free_{free}"
        with full_disk(place, free, partial(put, place)) as make_room:
            code, said = said_by(place)
            left = files(place)
            assert code == 2, said
            assert "No space left on device" in said or "File too large" in said
            assert "unexpected" not in said
            assert not [file for file in left if file.endswith(LEFTOVER_SUFFIX)]
            final = left.keys() & whole.keys()
            assert {file for file in final if left[file] not in (before.get(file), whole[file])} <= RUN_FILES
            if not free:
                continue
            make_room()
            code, said = said_by(place)
            assert code == line.code, said
            again, once = settled_files(place), settled_files(roomy)
            assert again == once
