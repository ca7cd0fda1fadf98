"""`siggen-diagnostics predict`: what saved models, or the network that comes along, say about a recording."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from diagnostics.cli.recording_options import (
    GearOptions,
    RecordingOptions,
    SaidReading,
    file_rows,
    recordings_of,
    two_gears,
)
from diagnostics.cli.set_options import OwnIndicators
from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped
from siggen.errors import EXIT_USAGE, UsageError

if TYPE_CHECKING:
    from diagnostics.prediction.prediction import Prediction
    from diagnostics.recordings.measured_recording import MeasuredRecording
    from diagnostics.recordings.taken import RecordingFacts, Source


@dataclass(frozen=True, slots=True)
class ReferenceOptions:
    """Healthy recordings of the same machine."""

    reference: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE[:ROW,ROW]",
            help="Healthy recording of the same machine, with the same columns and unit. May be given several times.",
        ),
    ] = None


@grouped
def predict(
    file: Annotated[
        list[str],
        typer.Argument(
            metavar="[MODEL] FILE...",
            help="Recordings: .csv, .txt, .lvm, .mat, .wav, .npz, .tdms, .uff, .h5, .mf4, .parquet (FILE:ROW,ROW) and "
            "others; before them a folder that `report` wrote, whose models are then asked.",
            show_default=False,
        ),
    ],
    *,
    gears: GearOptions,
    recording: RecordingOptions,
    healthy: ReferenceOptions,
    indicator: OwnIndicators = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="DIR", help="Folder for JSON, plots and page; of several, one each in it."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Say whether recordings show damage of teeth, or why that cannot be told.

    Without MODEL by the network that comes along, which has learnt from simulated gearboxes of many kinds: damage, its
    kind, gear and size, or that none is seen. With MODEL the state of its set that each is most like.

    Of several recordings, those that cannot be used are named behind the others; the exit code is then 2.

    Example: siggen-diagnostics predict run.csv --fs 25600 --teeth 18,47 --speed 30,40
    Example: siggen-diagnostics predict runs/quickstart_report run.csv --fs 25600 --teeth 18,47 --speed 30,40
    """
    if Path(file[0]).is_dir() or not (Path(file[0]).suffix or Path(file[0]).exists()):
        folder, *file = file
        if not file:
            raise UsageError(f"predict: received no recording beside {folder}; allowed: predict [MODEL] FILE...")
        told = _by_model(Path(folder), file, gears, recording, healthy, indicator)
    else:
        if indicator:
            raise UsageError("--indicator: received without MODEL; allowed with a folder that `report` wrote")
        told = _by_network(file, gears, recording, healthy)
    if told.refused and not told.found:
        raise UsageError("\n".join(told.refused.values()))
    if as_json:
        echo_json({"predictions": [told.facts(one) for one in told.found.values()], "refused": told.refused})
    else:
        told.say()
    if out is not None:
        sources = recordings_of(file)
        folders = dict(zip(_names(sources), _folders(sources), strict=True))
        for name, one in told.found.items():
            echo(str(told.write(one, out / folders[name] if len(sources) > 1 else out)), err=as_json)
    if told.refused:
        raise typer.Exit(EXIT_USAGE)


@dataclass(frozen=True, slots=True)
class RecordingAnswers:
    """What is said by recording, why of others nothing, and how it is told: JSON, headline with rows, page."""

    found: Mapping[str, Any]
    refused: Mapping[str, str]
    facts: Callable[[Any], dict[str, Any]]
    text: Callable[[Any], tuple[str, list[tuple[str, str]]]]
    write: Callable[[Any, Path], Path]
    meaning: str

    def say(self) -> None:
        """Print what was found of every recording, first in one line."""
        for name, one in self.found.items():
            headline, rows = self.text(one)
            echo(f"{name}: {headline}")
            for label, text in rows:
                echo(f"  {label + ':':21} {text}")
        for name, reason in self.refused.items():
            echo(f"{name}: cannot tell: {reason}")
        echo(self.meaning)


def _by_model(
    folder: Path,
    file: Sequence[str],
    gears: GearOptions,
    recording: RecordingOptions,
    healthy: ReferenceOptions,
    indicator: OwnIndicators,
) -> RecordingAnswers:
    """Ask the models of a folder."""
    from diagnostics.base.extras import require_packages
    from diagnostics.base.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators

    require_packages("prediction", "sklearn", "skops")
    with terminal_stage("reading the models", 1):
        from diagnostics.prediction.prediction import predict_recording
        from diagnostics.prediction.prediction_page import (
            MEANING,
            prediction_facts,
            prediction_headline,
            prediction_rows,
            write_prediction,
        )
        from diagnostics.prediction.released_model import check_judges, load_model

        loaded = load_model(folder, load_indicators(indicator))
        check_judges(loaded, referenced=bool(healthy.reference))
    sources, facts = recordings_of(file), loaded.facts
    reading = recording.read(sources[0], gears.teeth)
    trained = f" (this model was trained on {' or '.join(f'{a},{b}' for a, b in facts.teeth)})"
    pair, span = _teeth(sources[0][0], gears.said(reading), trained), reading.speed_range_hz()
    references = _references(healthy, reading, facts.channels, facts.units)

    def ask(read: MeasuredRecording) -> Prediction:
        return predict_recording(loaded, read, pair, span, references)

    return RecordingAnswers(
        *_asked(sources, reading, facts.channels, facts.units, ask),
        lambda one: prediction_facts(one, facts),
        lambda one: (prediction_headline(one), prediction_rows(one)),
        lambda one, place: write_prediction(one, facts, place),
        MEANING,
    )


def _by_network(
    file: Sequence[str], gears: GearOptions, recording: RecordingOptions, healthy: ReferenceOptions
) -> RecordingAnswers:
    """Ask the network that comes with the package."""
    from diagnostics.base.extras import require_packages
    from diagnostics.base.progress import terminal_stage

    require_packages("the network", "safetensors")
    with terminal_stage("reading the network", 1):
        from diagnostics.prediction.gearbox_answer import gearbox_answer
        from diagnostics.prediction.prediction_page import MEANING_OF_NETWORK, write_answer
        from diagnostics.training.shipped_network import shipped_network

        shipped_network()
    sources = recordings_of(file)
    reading = recording.read(sources[0], gears.teeth)
    pair, span = _teeth(sources[0][0], gears.said(reading), ""), reading.speed_range_hz()
    references = _references(healthy, reading, None, ())
    found = _asked(sources, reading, None, (), lambda read: gearbox_answer(read, pair, span, references))
    return RecordingAnswers(
        *found, lambda one: one.facts, lambda one: (one.headline, one.rows), write_answer, MEANING_OF_NETWORK
    )


def _references(
    healthy: ReferenceOptions, reading: SaidReading, names: tuple[str, ...] | None, units: tuple[str, ...]
) -> tuple[MeasuredRecording, ...]:
    from diagnostics.recordings.measured_recording import read_recording

    facts = reading.facts()
    return tuple(
        read_recording(path, names, _reference_facts(facts, path, number), units)
        for said in healthy.reference or ()
        for path, number in file_rows(said)
    )


def _asked(
    sources: Sequence[Source],
    reading: SaidReading,
    names: tuple[str, ...] | None,
    units: tuple[str, ...],
    ask: Callable[[MeasuredRecording], Any],
) -> tuple[dict[str, Any], dict[str, str]]:
    """Return what is said of every recording, and why of others nothing."""
    from diagnostics.base.progress import terminal_stage
    from diagnostics.recordings.measured_recording import read_recording

    found, refused, facts = {}, {}, reading.facts()
    with terminal_stage("prediction", len(sources)) as advance:
        for name, (path, row) in zip(_names(sources), sources, strict=True):
            try:
                found[name] = ask(read_recording(path, names, replace(facts, row=row), units))
            except UsageError as error:
                refused[name] = str(error)
            advance()
    return found, refused


def _names(sources: Sequence[Source]) -> list[str]:
    """Return what recordings are called: by their files, by whole paths where two of these have one name."""
    files = [path.as_posix() if _alike(sources) else path.name for path, _ in sources]
    return [file if row is None else f"{file}:{row}" for file, (_, row) in zip(files, sources, strict=True)]


def _folders(sources: Sequence[Source]) -> list[str]:
    """Return what the folder of each is called: like the recording, in one part."""
    files = [path.relative_to(path.anchor).parts if _alike(sources) else (path.name,) for path, _ in sources]
    rows = [() if row is None else (str(row),) for _, row in sources]
    return ["_".join((*file, *row)) for file, row in zip(files, rows, strict=True)]


def _alike(sources: Sequence[Source]) -> bool:
    return len({(path.name, row) for path, row in sources}) < len(sources)


def _teeth(file: Path, said: str | None, trained: str) -> tuple[int, int]:
    if said is None:
        raise UsageError(
            f"{file}: teeth unknown. Orders, averages and sidebands need them. Give --teeth PINION,GEAR{trained}"
        )
    return two_gears(said)


def _reference_facts(facts: RecordingFacts, path: Path, row: int | None) -> RecordingFacts:
    """Return what is said about a reference: as about the recording, but for its row, and a rate that it states."""
    from diagnostics.recordings.taken import take

    unsaid = replace(facts, row=row, fs_hz=None)
    try:
        return unsaid if take(path, unsaid, say=False).fs_hz else replace(facts, row=row)
    except UsageError:  # a time that the rate explains, or nothing that can be read
        return replace(facts, row=row)
