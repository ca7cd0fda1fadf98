"""`siggen-diagnostics baseline`: a machine's healthy state from recordings of it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.recording_options import GearOptions, RecordingOptions, recordings_of
from siggen.cli.echo import echo
from siggen.cli.option_groups import grouped
from siggen.errors import EXIT_USAGE, UsageError


@grouped
def baseline(
    healthy: Annotated[
        list[str],
        typer.Argument(
            metavar="HEALTHY...",
            help="Healthy recordings: .csv, .txt, .lvm, .mat, .wav, .npz, .tdms, .uff, .h5, .mf4, .parquet "
            "(FILE:ROW,ROW) and others; 4 at least.",
            show_default=False,
        ),
    ],
    out: Annotated[Path, typer.Option("--out", "-o", metavar="MACHINE", help="New folder of the machine.")],
    *,
    gears: GearOptions,
    recording: RecordingOptions,
    load: Annotated[
        str,
        typer.Option(
            "--load",
            metavar="L[,L...]|slip",
            help="Load in any unit: of all recordings, or one for each; `slip`: by an induction motor's speed.",
        ),
    ] = "",
    false_alarms: Annotated[
        float, typer.Option(min=0.001, max=0.3, help="Wanted rate of false alarms of `check`.")
    ] = 0.05,
) -> None:
    """Learn what a healthy machine looks like, for `check` of later recordings. No simulation is needed.

    Recordings that cannot be used are named behind the others; the exit code is then 2.

    Example: siggen-diagnostics baseline 1.csv 2.csv 3.csv 4.csv --fs 25600 --teeth 25,56 --speed 14,26 -o rig
    """
    from diagnostics.base.extras import require_packages
    from diagnostics.base.progress import terminal_stage
    from diagnostics.machine.check import rate_sentence
    from diagnostics.machine.healthy_state import first_readable, healthy_state, thin_sentence
    from diagnostics.machine.machine import save_machine
    from diagnostics.recordings.taken import channel_names, unit_or_unknown
    from diagnostics.records.gear_train import gear_names

    require_packages("a machine", "jinja2")
    sources = recordings_of(healthy)
    read = recording.read(sources[0], gears.teeth)
    train, facts, span = gears.train(read, "--teeth"), read.facts(), read.speed_range_hz()
    first = first_readable(sources, facts)
    names = tuple(facts.columns) or channel_names(first)
    facts = unit_or_unknown(first, names, facts)
    with terminal_stage("healthy recordings", len(sources)) as advance:
        machine, refused = healthy_state(sources, names, facts, train, span, _loads(load), false_alarms, advance)
    save_machine(machine, out)
    shaft = gear_names(train)[0].gears[0]
    speeds = f"{machine.speed_hz.min():.4g} to {machine.speed_hz.max():.4g} Hz"
    echo(f"{len(machine.references)} recordings, {len(machine.channels)} channels, {shaft} at {speeds}", err=True)
    for reference, speed_hz, angle in zip(machine.references, machine.speed_hz, machine.angles, strict=True):
        echo(f"{reference}: {speed_hz:.4f} Hz ({angle})", err=True)
    for name, reason in refused.items():
        echo(f"{name}: left out: {reason}", err=True)
    for doubt in [*machine.doubts, *filter(None, [thin_sentence(machine)])]:
        echo(f"doubtful: {doubt}", err=True)
    echo(rate_sentence(len(machine.references), false_alarms), err=True)
    echo(str(out))
    if refused:
        raise typer.Exit(EXIT_USAGE)


def _loads(said: str) -> list[float] | None:
    """Return the loads as numbers, none of them, or None where slip tells them."""
    if said == "slip":
        return None
    try:
        return [float(part) for part in said.split(",")] if said else []
    except ValueError:
        raise UsageError(f"--load: received '{said}'; allowed: numbers with commas between, or slip") from None
