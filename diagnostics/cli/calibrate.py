"""`siggen-diagnostics calibrate`: a configuration fitted to healthy recordings of the machine."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from diagnostics.cli.recording_options import RecordingOptions, file_rows, recordings_of
from siggen.cli.echo import echo
from siggen.cli.option_groups import grouped

if TYPE_CHECKING:
    from diagnostics.calibration.calibration import Calibration

MOST_COMPARED, INJECTED = 8, 2
"""Gearboxes of rig and result on the page, about 1 s each; gearboxes whose damage is injected into each recording."""


@dataclass(frozen=True, slots=True)
class DrawOptions:
    """What is drawn."""

    gearboxes: Annotated[
        int,
        typer.Option(
            min=2,
            max=200,
            help="Gearboxes simulated for their bearing forces, about 1 s each, and paths drawn of each "
            "channel; the page compares up to 8.",
        ),
    ] = 24
    seed: Annotated[int, typer.Option(min=0, help="Seed of what is drawn.")] = 0


@dataclass(frozen=True, slots=True)
class UseOptions:
    """What else is done with recordings."""

    held_out: Annotated[
        list[str] | None,
        typer.Option(
            "--held-out",
            metavar="FILE[:ROW,ROW]",
            help="Healthy recordings that the page judges by, not used for the fit. May be given several times.",
        ),
    ] = None
    inject: Annotated[
        Path | None,
        typer.Option(
            "--inject",
            metavar="FOLDER",
            help="Also write a set of the recordings plus simulated damage, two gearboxes for each recording.",
        ),
    ] = None


@grouped
def calibrate(
    machine: Annotated[
        Path,
        typer.Argument(metavar="MACHINE", help="Configuration of the machine, as `siggen init` writes it."),
    ],
    healthy: Annotated[
        list[str],
        typer.Argument(
            metavar="HEALTHY...",
            help="Healthy recordings of one rate: .csv, .txt, .lvm, .mat, .wav, .npz, .tdms, .uff, .h5, .mf4, .parquet "
            "(FILE:ROW,ROW) and others; 3 or more.",
            show_default=False,
        ),
    ],
    out: Annotated[Path, typer.Option("--out", "-o", metavar="YAML", help="New configuration; data go beside it.")],
    *,
    recording: RecordingOptions,
    draws: DrawOptions,
    use: UseOptions,
) -> None:
    """Fit a configuration to healthy recordings: `siggen generate` then draws sets that resemble the machine.

    Transfer paths, noise, its modulation, lines beside the mesh, speed and resolution follow from the recordings, with
    intervals from leaving recordings out. What they cannot tell is drawn per gearbox and named.

    Example: siggen-diagnostics calibrate gearbox.yaml may.csv june.csv july.csv --fs 25600 --speed 14,26 -o mine.yaml
    """
    import siggen
    from diagnostics.base.extras import require_packages
    from diagnostics.base.progress import terminal_stage
    from diagnostics.calibration.calibrated_files import check_new, write_calibration
    from diagnostics.calibration.calibration import calibrated
    from diagnostics.calibration.calibration_page import calibration_page
    from diagnostics.calibration.healthy_blocks import healthy_blocks, held_out_blocks
    from diagnostics.calibration.injection import write_injected
    from diagnostics.calibration.path_draws import family_size
    from diagnostics.calibration.rig import check_speeds, read_rig, rig_channels

    check_new(out, use.inject)
    require_packages("the page of a calibration", "matplotlib")
    sources = recordings_of(healthy)
    read = recording.read(sources[0])
    with terminal_stage("the rig", 1):
        described = read_rig(machine)
    teeth = described.drive.teeth
    names, columns = rig_channels(described, sources[0], read.facts())
    facts, span = read.facts(columns), read.speed_range_hz()
    with terminal_stage("healthy recordings", 1) as advance:
        blocks = healthy_blocks(sources, names, facts, teeth, span)
        others = [source for entry in use.held_out or () for source in file_rows(entry)]
        judges = held_out_blocks(others, blocks, facts, teeth, span)
        check_speeds(described, (*blocks.blocks, *(judges.blocks if judges else ())))
        advance()
    family, seed = family_size(draws.gearboxes, len(names), len(described.forces)), draws.seed
    with terminal_stage("gearboxes", draws.gearboxes) as advance:
        calibration = calibrated(described, blocks, read.file.torque_nm, draws.gearboxes, family, seed, advance)
    write_calibration(calibration, out)
    for block in (*blocks.blocks, *(judges.blocks if judges else ())):
        echo(f"{block.name}: {block.speed_hz:.4f} Hz ({block.origin})", err=True)
    siggen.load_config(out)  # what would be refused is said now
    _tell(calibration)
    echo(str(out))
    if use.inject is not None:
        with terminal_stage("injected gearboxes", INJECTED * len(blocks.blocks)) as advance:
            echo(str(write_injected(blocks, out, INJECTED, use.inject, seed, advance)))
    compared = min(MOST_COMPARED, draws.gearboxes)
    with terminal_stage("records to compare", 2 * compared) as advance:
        written, sentences = calibration_page(calibration, out, judges, (compared, seed), advance)
    echo("\n".join([*sentences[:2], str(written)]))


def _tell(calibration: Calibration) -> None:
    """Say what was fitted, and to stderr what was not identified."""
    import numpy as np

    from diagnostics.calibration.calibrated_files import CALIBRATED, TOO_FEW, not_identified
    from diagnostics.calibration.healthy_blocks import FEWEST_RECORDINGS
    from diagnostics.calibration.path_draws import housing_mass_kg, path_level_doubt

    for fit in calibration.channels:
        noise, depths = fit.noise, [depth.value for depth in fit.noise.depths]
        echo(
            f"{fit.name}: noise {noise.level_db.value:.1f} dB re 1 (m/s2)^2, shaft depths {depths[0]:.2f} and "
            f"{depths[1]:.2f}, {len(fit.own)} lines beside the mesh, {len(fit.paths)} paths"
        )
    if len(calibration.blocks.blocks) < FEWEST_RECORDINGS:
        echo(f"recordings: {len(calibration.blocks.blocks)}; {TOO_FEW}", err=True)
    if calibration.stage is not None or not calibration.rig.shows_other_stages:
        echo(CALIBRATED.stage(calibration))
    for text in not_identified(calibration):
        echo(f"not identified: {text}", err=True)
    paths = np.array([draw.accelerance for channel in calibration.channels for draw in channel.paths])
    mass_kg = housing_mass_kg(calibration.rig.config)
    if mass_kg is not None and (doubt := path_level_doubt(mass_kg, calibration.grid_hz, paths)):
        echo(doubt, err=True)
