"""`write_file`: the old file or the whole new one, whatever happens on the way."""

from __future__ import annotations

import resource
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
