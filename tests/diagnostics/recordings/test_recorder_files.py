"""TDMS, universal files and HDF5: what was written comes back with its rate and unit; damaged files end in words."""

from __future__ import annotations

import functools
import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path
from random import Random

import numpy as np
import pytest

from diagnostics.cli.app import main
from diagnostics.recordings.columns import read_columns
from diagnostics.recordings.file_columns import file_columns
from diagnostics.recordings.measured_recording import read_recording
from diagnostics.recordings.recorder_files import rate_from_increment
from diagnostics.recordings.taken import RecordingFacts
from siggen.errors import UsageError
from tests.faults.mutated_recordings import judged, mutated_bytes

pytestmark = pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")  # of pyuff, when it writes binary
FS_HZ, SAMPLES, NAMES = 51_200, 25_600, ("vertical", "horizontal")
STANDARD_GRAVITY_M_S2 = 9.80665


@functools.cache
def signals() -> np.ndarray:
    """Return lines of 20 and 30 teeth at 25 Hz in noise, of two channels, in g, with the digits that type 58 keeps."""
    time_s, rng = np.arange(SAMPLES) / FS_HZ, np.random.default_rng(8)
    mesh = sum(np.sin(2 * np.pi * 500.0 * k * time_s) / k for k in (1, 2, 3))
    shafts = (np.cos(2 * np.pi * (k * hz * time_s + rng.uniform())) for hz in (25.0, 50.0 / 3.0) for k in range(1, 121))
    both = mesh + 0.05 * sum(shafts) + 0.02 * rng.standard_normal((2, SAMPLES))
    return np.vectorize(lambda value: float(f"{value:.11e}"))(both)


def tdms(path: Path) -> None:
    pytest.importorskip("nptdms")
    from nptdms import ChannelObject, TdmsWriter

    facts = {"wf_increment": 1.0 / FS_HZ, "unit_string": "g"}
    slow = ChannelObject("run", "oil", np.arange(10.0), {"wf_increment": 1.0, "unit_string": "Deg C"})
    with TdmsWriter(path) as writer:
        channels = [ChannelObject("run", name, one, facts) for name, one in zip(NAMES, signals(), strict=True)]
        writer.write_segment([*channels, slow])


def universal(path: Path, binary: int = 0, unit: str = "g") -> None:
    pyuff = pytest.importorskip("pyuff")
    file = pyuff.UFF(str(path))
    for number, one in enumerate(signals()):
        stated = {"binary": binary, "func_type": 1, "id1": NAMES[number], "abscissa_spacing": 1, "data": one}
        place = {"rsp_node": 1, "rsp_dir": 2, "ref_node": 0, "ref_dir": 0, "x": np.arange(SAMPLES) / FS_HZ}
        types = {"abscissa_spec_data_type": 17, "ordinate_spec_data_type": 12, "orddenom_spec_data_type": 0}
        kinds = {**types, "ordinate_axis_units_lab": unit}
        file.write_sets({"type": 58, **stated, **place, **kinds}, "add")


def binary_universal(path: Path) -> None:
    universal(path, binary=1)


def hdf5(path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        file.attrs["Sampling_Rate"] = FS_HZ
        for name, one in zip(NAMES, signals(), strict=True):
            data = file.create_dataset(f"run/{name}", data=one, compression="gzip")
            data.attrs["unit"] = "g"
        file["note"] = "text"
        file["elsewhere"] = h5py.ExternalLink("other.h5", "/data")


WRITERS: dict[str, Callable[[Path], None]] = {
    "tdms": tdms,
    "uff": universal,
    "unv": binary_universal,
    "h5": hdf5,
}


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Give the function that returns a file of a kind, written once."""
    folder = tmp_path_factory.mktemp("sound")

    @functools.cache
    def written(kind: str) -> Path:
        WRITERS[kind](folder / f"run.{kind}")
        return folder / f"run.{kind}"

    return written


@pytest.mark.parametrize("kind", WRITERS)
def test_values_rate_and_unit_come_back_from_the_file_alone(kind: str, sound: Callable[[str], Path]) -> None:
    path = sound(kind)
    found = read_recording(path, NAMES, RecordingFacts())
    for name, expected in zip(NAMES, signals(), strict=True):
        np.testing.assert_array_equal(read_columns(path).values[name], expected)
        np.testing.assert_array_equal(found.channels[name], STANDARD_GRAVITY_M_S2 * expected)
    assert found.fs_hz == FS_HZ  # type 58 keeps six digits of 1/51200 s
    with pytest.raises(UsageError, match=r"states the unit g of vertical, the rig file m/s2"):
        read_recording(path, NAMES, RecordingFacts(unit="m/s2"))
    with pytest.raises(UsageError, match="states 51200 Hz, received 48000 Hz by --fs"):
        read_recording(path, NAMES, RecordingFacts(fs_hz=48_000.0))


@pytest.mark.parametrize("kind", WRITERS)
def test_the_command_ends_with_one_sentence_where_a_file_was_cut(
    kind: str,
    sound: Callable[[str], Path],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    content, path = sound(kind).read_bytes(), tmp_path / f"run.{kind}"
    command = ["siggen-diagnostics", "indicators", str(path), "--teeth", "20,30", "--speed", "20,30"]
    monkeypatch.setattr(sys, "argv", command)
    for share in (0.0, 0.01, 0.4, 0.6, 0.99):  # at 0.5 lies the end of the first of two equal records: a whole file
        path.write_bytes(content[: int(share * len(content))])
        with pytest.raises(SystemExit) as ended:
            main()
        said = capsys.readouterr().err.strip()
        assert ended.value.code == 2, (share, said)
        assert said.startswith(f"siggen-diagnostics: {path}: "), share
        assert "\n" not in said, (share, said)


@pytest.mark.parametrize("kind", WRITERS)
def test_mutated_files_give_a_recording_or_a_sentence(kind: str, sound: Callable[[str], Path], tmp_path: Path) -> None:
    path, chance = tmp_path / f"run.{kind}", Random(11)
    content = sound(kind).read_bytes()
    outcomes = []
    for _ in range(30):
        path.write_bytes(mutated_bytes(content, chance))
        case = judged(path.name, lambda: read_recording(path, None, RecordingFacts()))
        assert case.outcome in ("accepted", "refused"), case.message
        assert case.outcome == "accepted" or case.message.startswith(str(path))
        outcomes.append(case.outcome)
    assert set(outcomes) == {"accepted", "refused"}


def test_a_unit_that_is_not_known_is_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "run.uff"
    universal(path, unit="EU")
    with pytest.raises(UsageError, match=r"run.uff: states the unit 'EU' of vertical; .*unit: g"):
        read_recording(path, NAMES, RecordingFacts())
    found = read_recording(path, NAMES, RecordingFacts(unit="mm/s2"))
    np.testing.assert_allclose(found.channels["vertical"], 1e-3 * signals()[0])


def test_spectra_are_no_recordings(tmp_path: Path) -> None:
    pyuff = pytest.importorskip("pyuff")
    path = tmp_path / "run.uff"
    stated = {"type": 58, "func_type": 2, "abscissa_spacing": 1, "data": np.ones(8), "x": np.arange(8.0)}
    place = {"rsp_node": 1, "rsp_dir": 2, "ref_node": 0, "ref_dir": 0}
    place |= {"ordinate_spec_data_type": 12, "orddenom_spec_data_type": 0}
    pyuff.UFF(str(path)).write_sets({**stated, **place}, "overwrite")
    with pytest.raises(UsageError, match=r"holds no time record: 1 data sets of type 58"):
        read_columns(path)


def test_repeated_names_take_their_groups_and_steps_are_rates(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "run.hdf5"
    with h5py.File(path, "w") as file:
        for place in ("in", "out"):
            file[f"{place}/accel"] = np.arange(5.0)
            file[f"{place}"].attrs["dt"] = 1.0 / FS_HZ
    found = read_columns(path)
    assert list(found.values) == ["in/accel", "out/accel"]
    assert found.fs_hz == FS_HZ


@pytest.mark.parametrize(
    ("step", "digits", "rate_hz"),
    [
        (1.95313e-05, 6, 51_200.0),
        (2.048e-05, 6, 48_828.125),
        (1.0 / 49.0, 15, 49.0),
        (0.0, 6, None),
        (float("nan"), 6, None),
        ("1", 6, None),
    ],
)
def test_rates_of_steps(step: object, digits: int, rate_hz: float | None) -> None:
    assert rate_from_increment(step, digits) == rate_hz


@pytest.mark.parametrize(("kind", "package"), [("tdms", "nptdms"), ("uff", "pyuff"), ("h5", "h5py")])
def test_a_missing_library_names_its_extra(
    kind: str, package: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / f"run.{kind}"
    path.write_bytes(b"anything")
    found = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == package else found(name))
    with pytest.raises(
        UsageError, match=rf"needs {package}, which is not installed; `pip install '.\[recordings\]'"
    ) as caught:
        file_columns(path)
    assert "\n" not in str(caught.value)
