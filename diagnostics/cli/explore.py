"""`siggen-diagnostics explore`: records of a set, or recordings, as the report shows them, without a judgement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from diagnostics.base.beside import beside as path_beside
from diagnostics.base.progress import Stage
from diagnostics.cli.recording_options import GearOptions, RecordingOptions, file_rows
from diagnostics.cli.set_options import AmountOptions, Open, OwnIndicators, opened
from siggen.cli.echo import echo
from siggen.cli.option_groups import grouped
from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.explore.measured_page import ShownRecording
    from diagnostics.machine.recording_indicators import RecordingIndicators
    from diagnostics.recordings.taken import RecordingFacts
    from siggen.columns.drivetrain import GearTrain

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
    found = _read(said, known.train, facts, known.speed_range_hz, stage)
    return [_shown(one, verdicts.get(one.name, UNKNOWN), loads.get(one.name)) for one in found]


def of_files(
    said: Sequence[str],
    healthy: Sequence[str],
    train: GearTrain,
    facts: RecordingFacts,
    speed_range_hz: tuple[float, float] | None,
    stage: Stage,
) -> list[ShownRecording]:
    """Return recordings that the user describes; those of `healthy` are the references."""
    from diagnostics.explore.measured_page import REFERENCE, UNKNOWN

    references = _read(healthy, train, facts, speed_range_hz, stage)
    others = _read(said, train, facts, speed_range_hz, stage)
    return [*(_shown(one, REFERENCE, None) for one in references), *(_shown(one, UNKNOWN, None) for one in others)]


def _shown(found: RecordingIndicators, verdict: str, load: float | None) -> ShownRecording:
    from diagnostics.explore.measured_page import ShownRecording

    return ShownRecording(found, verdict, float("nan") if load is None else load)


def _read(
    said: Sequence[str],
    train: GearTrain,
    facts: RecordingFacts,
    speed_range_hz: tuple[float, float] | None,
    stage: Stage,
) -> list[RecordingIndicators]:
    from diagnostics.machine.recording_indicators import recording_indicators

    sources = [source for one in said for source in file_rows(one)]
    found: list[RecordingIndicators] = []
    with stage("indicators of recordings", len(sources)) as advance:
        for path, row in sources:
            said_of = replace(facts, row=row)
            one = recording_indicators(path, train, said_of, speed_range_hz)
            echo(f"{one.name}: {one.pulses.speed_hz:.4f} Hz ({one.pulses.origin})", err=True)
            found.append(one)
            advance()
    return found


@dataclass(frozen=True, slots=True)
class SetOptions:
    """For sets only."""

    model: Annotated[
        Path | None,
        typer.Option(
            "--model",
            metavar="MODEL",
            help="Folder of `report`: shows what its logistic regression names every record.",
            show_default=False,
        ),
    ] = None
    indicator: OwnIndicators = None


@dataclass(frozen=True, slots=True)
class BesideOptions:
    """For recordings only."""

    beside: Annotated[
        Path | None,
        typer.Option(
            metavar="SET",
            help="A finished set, such as one that `calibrate` led to: recordings and its records on one page, laid "
            "over each other.",
            show_default=False,
        ),
    ] = None
    healthy: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE", help="A healthy recording to lay others over. May be given several times."),
    ] = None


@grouped
def explore(
    targets: Annotated[
        list[str],
        typer.Argument(
            metavar="DIR | MACHINE RECORDING... | RECORDING...",
            help="Folder or s3://... of a finished set; the folder that `baseline` wrote, with recordings; recordings.",
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
    show: Open = False,
    amount: AmountOptions,
    of_set: SetOptions,
    compared: BesideOptions,
    gears: GearOptions,
    recording: RecordingOptions,
) -> None:
    """Look at recordings, or at the records of a set at once: the page of `report` without its judgement.

    It opens from disk, without a network. The folder of a machine knows how its recordings are read.

    Example: siggen-diagnostics explore runs/quickstart --model runs/quickstart_report --open

    Example: siggen-diagnostics explore rig january.csv february.csv august.csv --beside runs/mine
    """
    first = Path(targets[0])
    if out and out.is_dir():
        raise UsageError(f"--out {out}: received a folder; allowed is the name of a file, such as {out / 'set.html'}")
    if (first / MACHINE_FILE).is_file() or gears.given or file_rows(targets[0])[0][0].is_file():
        _refuse_set_options(of_set)
        place = first.with_suffix("") if first.is_file() else first
        page = out or path_beside(place, "_explore.html")
        path = _recordings_page(targets, (gears, recording), page, compared, amount)
    elif compared.beside is not None:
        raise UsageError(f"--beside {compared.beside}: for recordings only; name them before it, or leave it out")
    elif len(targets) > 1:
        raise UsageError(f"{targets[1]}: a second argument after the folder {first}; allowed: one set at a time")
    else:
        path = _set_page(first, out, amount, of_set)
    echo(str(path))
    if show:
        opened(path)


def _refuse_set_options(options: SetOptions) -> None:
    said = {"--model": options.model, "--indicator": options.indicator}
    if given := [name for name, value in said.items() if value]:
        raise UsageError(f"{', '.join(given)}: for sets only; leave them out for recordings")


def _set_page(folder: Path, out: Path | None, amount: AmountOptions, of_set: SetOptions) -> Path:
    """Write the page of a set and return where."""
    from diagnostics.base.progress import terminal_stage
    from diagnostics.explore.set_page import LookOptions, write_set_page
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.prediction.released_model import load_model
    from diagnostics.report.life_report import lives_of
    from diagnostics.scoring.truth import is_lives
    from siggen.dataset.reading import open as open_set

    own, dataset = load_indicators(of_set.indicator), open_set(folder)
    model = None if of_set.model is None else load_model(of_set.model, own)
    options = LookOptions(**asdict(amount), model=model, own=own)
    adds = lives_of if is_lives(dataset) else None
    return write_set_page(dataset, out or path_beside(dataset.path, "_explore.html"), options, terminal_stage, adds)


def _recordings_page(
    targets: list[str],
    described: tuple[GearOptions, RecordingOptions],
    path: Path,
    compared: BesideOptions,
    amount: AmountOptions,
) -> Path:
    """Write the page of recordings, of a machine or of described files; beside a set where one is named."""
    from diagnostics.base.progress import terminal_stage
    from diagnostics.explore.measured_page import write_recordings_page

    folder, healthy = Path(targets[0]), compared.healthy or []
    if folder.is_dir():
        shown = of_machine(folder, [*targets[1:], *healthy], terminal_stage)
        name = folder.resolve().name
    else:
        gears, said = described
        train = gears.train(f"{targets[0]}: teeth unknown")
        shown = of_files(targets, healthy, train, said.facts(), said.speed_range_hz(), terminal_stage)
        name = ", ".join(Path(target).name for target in targets[:3])
    if compared.beside is None:
        return write_recordings_page(name, shown, path, full=amount.full, stage=terminal_stage)
    from diagnostics.explore.beside_page import write_beside_page
    from diagnostics.explore.set_page import LookOptions
    from siggen.dataset.reading import open as open_set

    options = LookOptions(**asdict(amount))
    return write_beside_page(name, shown, open_set(compared.beside), path, options, terminal_stage)
