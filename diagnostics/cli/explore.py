"""`siggen-diagnostics explore`: records of a set, or recordings, as the report shows them, without a judgement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from diagnostics.base.beside import beside as path_beside
from diagnostics.base.progress import Stage
from diagnostics.cli.recording_options import GearOptions, RecordingOptions, is_recording, recordings_of
from diagnostics.cli.set_options import Open, opened
from siggen.cli.echo import echo
from siggen.cli.option_groups import grouped
from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.explore.measured_page import ShownRecording
    from diagnostics.machine.recording_indicators import RecordingIndicators
    from diagnostics.prediction.released_model import ReleasedModel
    from diagnostics.recordings.taken import RecordingFacts
    from siggen.columns.drivetrain import GearTrain
    from siggen.dataset.reading import Dataset

MACHINE_FILE = "machine.json"
"""What the folder of a machine holds; its reader is slow to import."""


def of_machine(folder: Path, said: Sequence[str], stage: Stage) -> list[ShownRecording]:
    """Return recordings of a machine: its references by their names, the others with their latest verdict.

    Raises
    ------
    UsageError
        If no recording is given: the folder of a machine holds none of their samples.
    """
    from diagnostics.explore.measured_page import REFERENCE, UNKNOWN
    from diagnostics.machine.check import past_checks
    from diagnostics.machine.machine import load_machine

    known = load_machine(folder)
    if not said:
        raise UsageError(
            f"{folder}: holds no samples of its recordings; name their files too, such as: explore {folder.name} "
            f"{' '.join(known.references[:2])} august.csv"
        )
    loads = dict(zip(known.references, known.load.tolist(), strict=True))
    verdicts = {past.recording: past.verdict for past in past_checks(folder)} | dict.fromkeys(
        known.references, REFERENCE
    )
    facts = replace(known.facts, columns=known.facts.columns or {name: name for name in known.channels})
    recordings = _read(said, known.train, facts, known.speed_range_hz, stage)
    return [_shown(one, verdicts.get(one.name, UNKNOWN), loads.get(one.name)) for one in recordings]


def of_files(
    said: Sequence[str],
    train: GearTrain,
    facts: RecordingFacts,
    speed_range_hz: tuple[float, float] | None,
    stage: Stage,
) -> list[ShownRecording]:
    """Return recordings that the user describes."""
    from diagnostics.explore.measured_page import UNKNOWN

    return [_shown(recording, UNKNOWN, None) for recording in _read(said, train, facts, speed_range_hz, stage)]


def _shown(recording: RecordingIndicators, verdict: str, load: float | None) -> ShownRecording:
    from diagnostics.explore.measured_page import ShownRecording

    return ShownRecording(recording, verdict, float("nan") if load is None else load)


def _read(
    said: Sequence[str],
    train: GearTrain,
    facts: RecordingFacts,
    speed_range_hz: tuple[float, float] | None,
    stage: Stage,
) -> list[RecordingIndicators]:
    from diagnostics.machine.recording_indicators import recording_indicators

    sources = recordings_of(said)
    recordings: list[RecordingIndicators] = []
    with stage("indicators of recordings", len(sources)) as advance:
        for path, row in sources:
            said_of = replace(facts, row=row)
            recording = recording_indicators(path, train, said_of, speed_range_hz)
            echo(f"{recording.name}: {recording.pulses.speed_hz:.4f} Hz ({recording.pulses.origin})", err=True)
            recordings.append(recording)
            advance()
    return recordings


@grouped
def explore(
    targets: Annotated[
        list[str],
        typer.Argument(
            metavar="SET | [MACHINE] RECORDING... [SET]",
            help="Folder or s3://... of a finished set; or recordings, also behind the folder that `baseline` wrote. A "
            "set behind them, such as one that `calibrate` led to, is laid over them.",
            show_default=False,
        ),
    ],
    *,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            metavar="FILE",
            help="The page. Default: the first target's name and _explore.html.",
            show_default=False,
        ),
    ] = None,
    full: Annotated[bool, typer.Option("--full", help="Keep every sample, up to 30 MB of them.")] = False,
    show: Open = False,
    gears: GearOptions,
    recording: RecordingOptions,
) -> None:
    """Look at recordings, or at a set: the page of `report` without its judgement.

    It opens from disk, without a network. What `report` wrote beside a set (SET_report) names its records. The folder
    of a machine knows how its recordings are read, and which of them are healthy.

    Example: siggen-diagnostics explore runs/quickstart --open

    Example: siggen-diagnostics explore rig january.csv february.csv august.csv runs/mine
    """
    first = Path(targets[0])
    if out and out.is_dir():
        raise UsageError(f"--out {out}: received a folder; allowed is the name of a file, such as {out / 'set.html'}")
    if (first / MACHINE_FILE).is_file() or gears.teeth or is_recording(targets[0]):
        place = first.with_suffix("") if first.is_file() else first
        path = _recordings_page(targets, (gears, recording), out or path_beside(place, "_explore.html"), full)
    elif len(targets) > 1:
        raise UsageError(f"{targets[1]}: a second argument after the folder {first}; allowed: one set at a time")
    else:
        path = _set_page(first, out, full)
    echo(str(path))
    if show:
        opened(path)


def _set_page(folder: Path, out: Path | None, full: bool) -> Path:
    """Write the page of a set and return where."""
    from diagnostics.base.progress import terminal_stage
    from diagnostics.explore.set_page import LookOptions, write_set_page
    from diagnostics.indicators.workers import fitting_workers
    from diagnostics.report.life_report import lives_of
    from diagnostics.scoring.truth import is_lives
    from siggen.dataset.reading import open as open_set

    dataset = open_set(folder)
    workers = fitting_workers(dataset.labels(columns=["record_id"]).num_rows)
    options = LookOptions(full=full, workers=workers, model=None if is_lives(dataset) else _model_beside(dataset))
    adds = lives_of if is_lives(dataset) else None
    return write_set_page(dataset, out or path_beside(dataset.path, "_explore.html"), options, terminal_stage, adds)


def _model_beside(dataset: Dataset) -> ReleasedModel | None:
    """Return what `report` trained on this very set; None without it, or where it needs indicators of the user."""
    from diagnostics.base.extras import missing_packages
    from diagnostics.prediction.model_facts import FACTS_FILE
    from diagnostics.prediction.released_model import load_model
    from diagnostics.scoring.prediction_file import baselines_beside

    file = baselines_beside(dataset)
    if file is None or not (file.parent / FACTS_FILE).is_file() or missing_packages("sklearn", "skops"):
        return None
    try:
        return load_model(file.parent)
    except UsageError as error:
        echo(f"note: records are not named: {error}", err=True)
        return None


def _recordings_page(
    targets: list[str], described: tuple[GearOptions, RecordingOptions], path: Path, full: bool
) -> Path:
    """Write the page of recordings, of a machine or of described files; beside a set where one is named last."""
    from diagnostics.base.progress import terminal_stage
    from diagnostics.explore.measured_page import write_recordings_page

    is_set = len(targets) > 1 and (targets[-1].startswith("s3://") or (Path(targets[-1]) / "manifest.json").is_file())
    folder, files, beside = Path(targets[0]), targets[:-1] if is_set else targets, targets[-1] if is_set else None
    if folder.is_dir():
        shown = of_machine(folder, files[1:], terminal_stage)
        name = folder.resolve().name
    else:
        gears, said = described
        read = said.read(recordings_of(files)[0], gears.teeth)
        train = gears.train(read, f"{files[0]}: teeth unknown")
        shown = of_files(files, train, read.facts(), read.speed_range_hz(), terminal_stage)
        name = ", ".join(Path(target).name for target in files[:3])
    if beside is None:
        return write_recordings_page(name, shown, path, full=full, stage=terminal_stage)
    from diagnostics.explore.beside_page import write_beside_page
    from diagnostics.explore.set_page import LookOptions
    from siggen.dataset.reading import open as open_set

    return write_beside_page(name, shown, open_set(beside), path, LookOptions(full=full), terminal_stage)
