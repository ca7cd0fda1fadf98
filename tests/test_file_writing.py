"""`write_file`: the old file or the whole new one, whatever happens on the way."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from siggen.errors import UsageError
from siggen.file_writing import write_file


@contextmanager
def files_of_at_most(size: int) -> Iterator[None]:
    """Let the system refuse all that a file has beyond a size [bytes], in the midst of writing."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_folders_are_made_and_text_bytes_and_drafts_written(tmp_path: Path) -> None:
    path = tmp_path / "a" / "b" / "page.html"
    for content in ("ü", "ü".encode(), lambda draft: draft.write_text("ü", encoding="utf-8")):
        write_file(path, content)
        assert path.read_bytes() == "ü".encode()
        assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("before", [None, "old"])
def test_a_write_that_is_refused_in_the_midst_leaves_what_was_there(tmp_path: Path, before: str | None) -> None:
    path = tmp_path / "page.html"
    if before is not None:
        path.write_text(before)
    with (
        files_of_at_most(1000),
        pytest.raises(UsageError, match=r"page.html cannot be written: File too large"),
    ):
        write_file(path, "new" * 1000)
    assert [file.read_text() for file in tmp_path.iterdir()] == ([] if before is None else [before])


def test_an_interrupted_draft_leaves_nothing(tmp_path: Path) -> None:
    def interrupted(draft: Path) -> None:
        draft.write_text("half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_file(tmp_path / "page.html", interrupted)
    assert not list(tmp_path.iterdir())


def test_a_link_is_followed_and_no_folder_or_device_replaced(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "file")
    write_file(tmp_path / "link", "text")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "file").read_text() == "text"
    for path in (tmp_path, Path("/dev/null")):
        with pytest.raises(UsageError, match="is no regular file"):
            write_file(path, "text")


KILLED = """
import os, signal, sys, time
from pathlib import Path
from siggen.file_writing import write_file
def half(draft):
    draft.write_text("half")
    print(os.getpid(), flush=True)
    time.sleep(60)
write_file(Path(sys.argv[1]), half)
"""


def test_what_a_killed_process_left_goes_with_the_next_write_and_a_living_ones_stays(tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    dead, alive = (
        subprocess.Popen([sys.executable, "-P", "-c", KILLED, path], stdout=subprocess.PIPE, text=True)
        for _ in range(2)
    )
    try:
        for one in (dead, alive):
            assert one.stdout is not None
            one.stdout.readline()
        other = tmp_path / ".page.html.0123abcd-1-0123abcd.siggen-part"
        other.write_text("of another machine")
        os.kill(dead.pid, signal.SIGKILL)
        dead.communicate()
        assert len(list(tmp_path.iterdir())) == 3
        write_file(path, "whole")
        left = {file.name for file in tmp_path.iterdir()} - {path.name, other.name}
        assert len(left) == 1
        assert f"-{alive.pid}-" in left.pop()
    finally:
        alive.kill()
        alive.communicate()
    write_file(path, "again")
    assert {file.name for file in tmp_path.iterdir()} == {path.name, other.name}
