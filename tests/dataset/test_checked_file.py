"""Checksums up to the reader: every byte that is given out was checked, and a set says whether it has them."""

from __future__ import annotations

import hashlib
import io
import shutil
import zlib
from collections.abc import Callable
from pathlib import Path
from random import Random

import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.dataset.checked_file import BLOCK_BYTES, CheckedFile, checksums
from siggen.dataset.reading import Dataset
from siggen.dataset.reading import open as open_set
from siggen.errors import DatasetError
from tests.dataset.fake_set import fake_config, write_fake_set

CONTENT = Random(1).randbytes(3 * BLOCK_BYTES + 1000)


def test_checksums_are_those_of_the_whole_file_and_of_its_blocks() -> None:
    found = checksums(io.BytesIO(CONTENT))
    blocks = [CONTENT[start : start + BLOCK_BYTES] for start in range(0, len(CONTENT), BLOCK_BYTES)]
    assert found.sha256 == hashlib.sha256(CONTENT).hexdigest()
    assert found.crc32_per_64_kib == "".join(f"{zlib.crc32(block):08x}" for block in blocks)


@given(place=st.integers(0, len(CONTENT) + 5), size=st.integers(-1, len(CONTENT)))
def test_any_piece_is_read_as_from_the_file_itself(place: int, size: int) -> None:
    plain, checked = io.BytesIO(CONTENT), CheckedFile(io.BytesIO(CONTENT), checksums(io.BytesIO(CONTENT))[1])
    assert checked.seek(place) == plain.seek(place)
    assert checked.read(size) == plain.read(size)
    assert checked.tell() == plain.tell()


@given(bit=st.integers(0, 8 * len(CONTENT) - 1), ahead=st.integers(0, 100), size=st.integers(101, 70_000))
def test_no_read_over_a_flipped_bit_gives_anything(bit: int, ahead: int, size: int) -> None:
    broken = bytearray(CONTENT)
    broken[bit // 8] ^= 1 << bit % 8
    file = CheckedFile(io.BytesIO(bytes(broken)), checksums(io.BytesIO(CONTENT))[1])
    file.seek(max(0, bit // 8 - ahead))
    with pytest.raises(OSError, match=r"bytes \d+ to \d+ do not match their checksum"):
        file.read(size)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sets") / "fake"
    write_fake_set(path, fake_config(internals={"quantities": ["all"], "records": "all"}))
    return path


def test_pages_carry_checksums_for_readers_of_others(folder: Path, tmp_path: Path) -> None:
    """Flip a bit of a signal's page: pyarrow itself refuses it when it is asked to look, and gives it out otherwise."""
    footer = pq.read_metadata(folder / "data/train-00000.parquet")
    index = footer.schema.names.index("element")  # the first channel's
    chunk = footer.row_group(0).column(index)
    content = bytearray((folder / "data/train-00000.parquet").read_bytes())
    content[chunk.data_page_offset + chunk.total_compressed_size - 9] ^= 1
    (tmp_path / "a.parquet").write_bytes(content)
    with pytest.raises(OSError, match="CRC"):
        pq.read_table(tmp_path / "a.parquet", page_checksum_verification=True)


READS: dict[str, Callable[[Dataset], object]] = {
    "data/train-00000.parquet": lambda dataset: list(dataset.records("train")),
    "internals/train-00000.parquet": lambda dataset: list(dataset.internals("train")),
    "metadata/train.parquet": lambda dataset: dataset.labels("train"),
    "damage/train.parquet": lambda dataset: dataset.damage("train"),
    "config.yaml": lambda dataset: None,
    "manifest.json": lambda dataset: None,
    "index.parquet": lambda dataset: None,
    "checksums.parquet": lambda dataset: list(dataset.records("train")),
}


@pytest.mark.parametrize("name", READS)
def test_a_flipped_bit_anywhere_in_a_file_is_refused_by_whoever_reads_it(
    folder: Path, tmp_path: Path, name: str
) -> None:
    shutil.copytree(folder, tmp_path / "set")
    file, chance = tmp_path / "set" / name, Random(name)
    whole = file.read_bytes()
    for _ in range(12):
        broken = bytearray(whole)
        broken[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
        file.write_bytes(broken)
        with pytest.raises(DatasetError, match=name.replace(".", r"\.")):
            READS[name](open_set(tmp_path / "set"))
    file.write_bytes(whole)
    READS[name](open_set(tmp_path / "set"))


def test_a_file_of_another_size_is_refused_when_it_is_read(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder, tmp_path / "set")
    with (tmp_path / "set/data/test-00000.parquet").open("ab") as file:
        file.write(b"x")
    with pytest.raises(DatasetError, match=r"test-00000\.parquet has .* bytes instead of"):
        list(open_set(tmp_path / "set").records("test"))
