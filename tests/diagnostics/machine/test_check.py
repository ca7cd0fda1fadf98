"""A machine from healthy recordings, and what is said of later ones: through the commands, on recordings made here."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from diagnostics.cli.app import app
from diagnostics.machine.check import past_checks
from siggen.errors import SiggenError, UsageError
from tests.rig_file import rig_file

FS_HZ, TEETH, SECONDS = 8000.0, 20, 2.0
RIG = ("--fs", FS_HZ, "--teeth", "20,31")
SEARCHED, TOLD = (*RIG, "--speed", "20,30"), (*RIG, "--rig", Path(__file__).with_name("pulses.yaml"))
"""Without a tacho the search for the speed takes nine tenths of a check: it is done where it is the subject."""


def write_recording(
    file: Path,
    seed: int,
    speed_hz: float = 25.0,
    gain: float = 1.0,
    seconds: float = SECONDS,
    knock: float = 0.0,
    jitter: float = 1e-3,
    moved: bool = False,
    tacho: bool = False,
) -> Path:
    """Mesh lines, weak sidebands, noise; one knock per turn where a tooth is damaged; with `tacho` a pulse per turn."""
    rng = np.random.default_rng(seed)
    turn = speed_hz * (1.0 + jitter * rng.normal()) * np.arange(round(seconds * FS_HZ)) / FS_HZ + rng.uniform()
    signal = sum(np.cos(2 * np.pi * TEETH * h * turn + h) / h for h in (1, 2, 3))
    signal = signal * (1.0 + 0.03 * np.cos(2 * np.pi * turn) + 0.01 * np.cos(2 * np.pi * turn * TEETH / 31))
    phase = turn % 1.0
    signal = signal + knock * np.exp(-phase / 0.01) * np.sin(2 * np.pi * 90.0 * phase)
    other = np.roll(signal, 3) * 0.7
    noise = 0.1 * rng.normal(size=(2, turn.size))
    time = np.arange(turn.size) / FS_HZ
    lid, side = signal + noise[0], other + noise[1]
    lid = np.gradient(lid) if moved else lid  # a place that favours high frequencies
    pulse = {"pulse": np.where(phase < 0.1, 5.0, 0.0)} if tacho else {}
    np.savez(file, t=time, lid=gain * lid, side=gain * side, **pulse)
    return file


def run(*arguments: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)
    return result.exit_code, result.output


@pytest.fixture(scope="module")
def machine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("machine")
    files = [write_recording(folder / f"healthy_{k}.npz", seed=k) for k in range(6)]
    code, said = run("baseline", *files, *SEARCHED, "--load", "40", "--out", folder / "rig")
    assert code == 0
    assert "6 recordings, 2 channels, pinion at 24.9" in said
    assert "takes 19 references" in said
    return folder / "rig"


def test_the_machine_again_is_unchanged_and_a_knocking_tooth_is_a_change(machine: Path, tmp_path: Path) -> None:
    healthy = write_recording(tmp_path / "healthy.npz", seed=50)
    knocking = write_recording(tmp_path / "knocking.npz", seed=51, knock=0.8)
    code, said = run("check", machine, healthy)
    assert (code, "healthy.npz: unchanged" in said) == (0, True), said
    assert '<p class="first passed">1 of 1 unchanged.</p>' in (machine / "machine.html").read_text()
    (tmp_path / "broken.npz").write_bytes(b"no archive")
    code, said = run("check", machine, tmp_path / "broken.npz", knocking)
    assert (code, "knocking.npz: changed" in said, "broken.npz: cannot tell" in said) == (4, True, True), said
    page = (machine / "machine.html").read_text()
    assert "knocking.npz" in page
    assert '<p class="first failed">1 of 1 changed.</p>' in page
    assert [past.verdict for past in past_checks(machine)][-2:] == ["unchanged", "changed"]


@pytest.mark.parametrize(
    ("changed", "verdict", "reason"),
    [
        ({"speed_hz": 28.0}, "other load or speed", "24.9"),
        ({"gain": 1000.0}, "cannot tell", "is the unit, sensitivity or gain"),
        ({"seconds": 0.7}, "cannot tell", "too short"),
    ],
)
def test_what_cannot_be_compared_is_said(
    machine: Path, tmp_path: Path, changed: dict[str, float], verdict: str, reason: str
) -> None:
    code, said = run("check", machine, write_recording(tmp_path / "new.npz", seed=60, **changed))
    assert code == 3
    assert f"new.npz: {verdict}" in said
    assert said.count("new.npz") == 1
    assert reason in said


def test_a_wrong_rate_is_known_by_the_tacho_and_leaves_no_trace(tmp_path: Path) -> None:
    files = [write_recording(tmp_path / f"healthy_{k}.npz", seed=k, tacho=True) for k in range(4)]
    assert run("baseline", *files, *TOLD, "--out", tmp_path / "rig")[0] == 0
    held = dict(np.load(write_recording(tmp_path / "new.npz", seed=9, tacho=True)))
    np.savez(tmp_path / "new.npz", **{name: values for name, values in held.items() if name != "t"})
    wrong = rig_file(tmp_path, fs_hz=2 * FS_HZ)
    with pytest.raises(
        UsageError, match=r"new.npz: 16000 Hz; the references 8000 Hz, their pinion 2\d.* this one 49\.9.*fs_hz: 8000"
    ):
        run("check", tmp_path / "rig", tmp_path / "new.npz", *wrong)
    assert past_checks(tmp_path / "rig") == []
    both = (
        "--teeth",
        "20,31",
        *rig_file(tmp_path, fs_hz=2 * FS_HZ, tacho="pulse", tacho_pulses=1, speed="20,30", unit="g"),
    )
    with pytest.raises(
        UsageError, match=r"the tacho gives 49\.9.* outside of 20 to 30 Hz.*sampling rate right, 16000 Hz"
    ):
        run("indicators", tmp_path / "new.npz", *both)
    assert run("check", tmp_path / "rig", tmp_path / "new.npz")[0] == 0


def test_another_load_is_not_compared(machine: Path, tmp_path: Path) -> None:
    _, said = run("check", machine, write_recording(tmp_path / "new.npz", seed=61), "--load", "80")
    assert "other load or speed" in said


def test_slips_are_named(tmp_path: Path) -> None:
    files = [write_recording(tmp_path / f"{k}.npz", seed=k, seconds=0.8) for k in range(4)]
    facts = (*SEARCHED, "--out", tmp_path / "rig")
    for arguments, told in (
        ((*files[:3], *facts), "3 healthy recordings; 4 are needed"),
        ((*files, files[0], *facts), "give every recording once"),
        ((*files, *facts, "--load", "1,2"), "one per recording"),
        ((*files, "--fs", FS_HZ, "--out", tmp_path / "rig"), "--teeth: received nothing"),
        ((*files, *facts[:4], "--out", tmp_path / "rig"), "neither tacho nor speed"),
    ):
        with pytest.raises(SiggenError, match=told):
            run("baseline", *arguments)
    with pytest.raises(SiggenError, match="is no machine"):
        run("check", tmp_path / "nothing", files[0])


def test_a_damaged_folder_is_named(machine: Path, tmp_path: Path) -> None:
    folder = tmp_path / "copy"
    folder.mkdir()
    for file in ("machine.json", "references.parquet"):
        (folder / file).write_bytes((machine / file).read_bytes())
    table = bytearray((folder / "references.parquet").read_bytes())
    table[200] ^= 1
    (folder / "references.parquet").write_bytes(table)
    with pytest.raises(SiggenError, match="is damaged"):
        run("check", folder, write_recording(tmp_path / "new.npz", seed=1))


def test_teeth_whose_mesh_lines_are_not_there_are_refused(tmp_path: Path) -> None:
    """With a tacho nothing else would notice: every order would be that of something else."""
    files = [write_recording(tmp_path / f"healthy_{k}.npz", seed=k) for k in range(4)]
    for seed, file in enumerate(files):
        held = dict(np.load(file))
        held["pulse"] = np.where((held["t"] * 25.0) % 1.0 < 0.1, 5.0, 0.0)
        rng = np.random.default_rng(seed)
        np.savez(file, **{k: v if k in {"t", "pulse"} else rng.standard_normal(v.size) for k, v in held.items()})
    facts = [*RIG, *rig_file(tmp_path, tacho_pulses=1, channels={"lid": "lid"}), "--out", tmp_path / "rig"]
    with pytest.raises(SiggenError, match="no mesh line of 20 teeth"):
        run("baseline", *files, *facts)


def loaded(file: Path, seed: int, load: float, **changed: float) -> Path:
    """Levels follow the load, and an induction motor slips by 0.5 % from none to full."""
    return write_recording(
        file, seed, 25.0 * (1.0 - 5e-5 * load), (load / 100.0) ** 0.8, jitter=0.0, tacho=True, **changed
    )


@pytest.mark.parametrize("way", ["numbers", "slip"])
def test_a_load_between_the_references_is_judged_and_one_outside_is_not(way: str, tmp_path: Path) -> None:
    loads = (20.0, 35.0, 60.0, 80.0, 100.0)
    files = [loaded(tmp_path / f"{k}.npz", k, load) for k, load in enumerate(loads)]
    said = ",".join(str(load) for load in loads) if way == "numbers" else "slip"
    facts = (*TOLD, "--load", said, "--out", tmp_path / "rig")
    assert run("baseline", *files, *facts)[0] == 0

    within = [loaded(tmp_path / f"within_{k}.npz", 20 + k, 47.0, knock=2.0 * k) for k in range(2)]
    outside = loaded(tmp_path / "outside.npz", 22, 140.0, knock=2.0)

    def verdicts(load: float, *new: Path) -> list[str]:
        given = ("--load", load) if way == "numbers" else ()
        printed = run("check", tmp_path / "rig", *new, *given)[1]
        return [re.search(rf"^{file.name}: ([^:;,]+)", printed, re.MULTILINE)[1] for file in new]  # type: ignore[index]

    assert verdicts(47.0, *within) == ["unchanged", "changed"]
    assert verdicts(140.0, outside) == ["other load or speed"]


def test_speeds_that_do_not_differ_tell_no_load(tmp_path: Path) -> None:
    files = [write_recording(tmp_path / f"{k}.npz", seed=k, speed_hz=25.0 + 1.4 * k, tacho=True) for k in range(4)]
    facts = (*TOLD, "--load", "slip", "--out", tmp_path / "rig")
    with pytest.raises(SiggenError, match="--load slip: speeds of the references differ by 15 %"):
        run("baseline", *files, *facts)


@pytest.mark.parametrize(
    ("odd", "off"),
    [({"gain": 1.0 / 9.81}, "20 dB"), ({"moved": True}, r"\d+ dB"), ({}, "")],
    ids=["in g", "a sensor elsewhere", "healthy"],
)
def test_a_reference_unlike_the_others_is_named_by_baseline_by_check_and_on_the_page(
    odd: dict[str, Any], off: str, tmp_path: Path
) -> None:
    files = [write_recording(tmp_path / f"healthy_{k}.npz", seed=80 + k, tacho=True) for k in range(3)]
    files.insert(1, write_recording(tmp_path / "odd.npz", seed=90, tacho=True, **odd))
    code, said = run("baseline", *files, *TOLD, "--out", tmp_path / "rig")
    _, later = run("check", tmp_path / "rig", write_recording(tmp_path / "new.npz", seed=91, tacho=True))
    named = rf"doubtful: reference 2 of 4, odd\.npz, is unlike the others: third octaves of (lid|side) are {off} off"
    assert code == 0
    for text in (said, later):
        assert bool(re.search(named, text)) == bool(odd), text
        assert text.count("unlike the others") == bool(odd)
    assert ("odd.npz, is unlike the others" in (tmp_path / "rig" / "machine.html").read_text()) == bool(odd)


def test_a_recording_in_g_is_called_changed_with_a_word_about_its_unit(machine: Path, tmp_path: Path) -> None:
    code, said = run("check", machine, write_recording(tmp_path / "in_g.npz", seed=52, gain=1.0 / 9.81), "--load", "40")
    assert code == 4
    assert "all channels are -20 dB off" in said
    assert "(g and m/s2 lie 20 dB apart)" in said


def test_a_load_is_asked_for_where_references_have_one_and_refused_where_they_have_none(
    machine: Path, tmp_path: Path
) -> None:
    new = write_recording(tmp_path / "new.npz", seed=53)
    assert "give --load as well" in run("check", machine, new)[1]
    files = [write_recording(tmp_path / f"healthy_{k}.npz", seed=60 + k, tacho=True) for k in range(4)]
    run("baseline", *files, *TOLD, "--out", tmp_path / "rig")
    with pytest.raises(UsageError, match="--load: received 40, but its references have none"):
        run("check", tmp_path / "rig", new, "--load", "40")


def test_a_file_that_cannot_be_read_is_left_out_and_three_references_give_no_verdict(
    tmp_path: Path,
) -> None:
    broken = tmp_path / "broken.npz"
    broken.write_bytes(b"no archive")
    files = [write_recording(tmp_path / f"slow_{k}.npz", seed=k, tacho=True) for k in range(3)]
    files.append(write_recording(tmp_path / "fast.npz", seed=9, speed_hz=30.0, tacho=True))
    code, said = run("baseline", broken, *files, *TOLD, "--out", tmp_path / "rig")
    assert (code, "broken.npz: left out" in said, "4 recordings, 2 channels" in said) == (2, True, True), said
    assert "fewer than 4 references, itself among them, at the speed and load of slow_0.npz" in said
    _, said = run("check", tmp_path / "rig", write_recording(tmp_path / "new.npz", seed=20, tacho=True))
    assert "new.npz: cannot tell: 3 healthy recordings at this speed and load; 4 are needed" in said


def test_a_renamed_column_is_mapped_and_another_load_that_nobody_gives_is_said(tmp_path: Path) -> None:
    files = [write_recording(tmp_path / f"healthy_{k}.npz", seed=k, tacho=True) for k in range(4)]
    run("baseline", *files, *TOLD, "--out", tmp_path / "rig")
    held = dict(np.load(write_recording(tmp_path / "louder.npz", seed=30, gain=1.5, tacho=True)))
    np.savez(tmp_path / "louder.npz", **{{"lid": "cover"}.get(name, name): values for name, values in held.items()})
    with pytest.raises(SiggenError, match=r"no column lid.*channels: .lid: COLUMN"):
        run("check", tmp_path / "rig", tmp_path / "louder.npz")
    code, said = run("check", tmp_path / "rig", tmp_path / "louder.npz", *rig_file(tmp_path, channels={"lid": "cover"}))
    assert (code, "louder.npz: changed" in said) == (4, True), said
    assert "all channels are louder than in every reference; other loads do that too: give --load to both" in said
