"""`siggen init`: a configuration of the user's own machine from a few numbers."""

from __future__ import annotations

import sys
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped


@dataclass(frozen=True, slots=True)
class MachineOptions:
    """The machine."""

    teeth: Annotated[str, typer.Option("--teeth", metavar="Z1,Z2", help="Teeth of pinion and gear.")] = ""
    module: Annotated[str, typer.Option("--module", metavar="MM", help="Module.")] = ""
    face_width: Annotated[str, typer.Option("--face-width", metavar="MM", help="Face width; else 8 modules.")] = ""
    speed: Annotated[
        str,
        typer.Option(
            "--speed", metavar="HZ", help="Of the pinion: one, or lowest,highest. In Hz, or as 1450rpm or 1450/60."
        ),
    ] = ""
    torque: Annotated[
        str,
        typer.Option(
            "--torque",
            metavar="NM",
            help="On the pinion: one, or lowest,highest; else what the gears are rated for.",
        ),
    ] = ""
    fs: Annotated[
        str, typer.Option("--fs", metavar="HZ", help="Sampling rate of your recordings; else ten mesh harmonics'.")
    ] = ""
    shift: Annotated[
        str,
        typer.Option("--shift", metavar="X1,X2", help="Profile shift in modules; one number: the pinion's."),
    ] = ""


@grouped
def init(
    out: Annotated[Path, typer.Option("--out", help="YAML file to write; never one that exists.")],
    *,
    numbers: MachineOptions,
    sensors: Annotated[int, typer.Option("--sensors", help="Number of accelerometers on the casing.")] = 2,
    damage: Annotated[
        str, typer.Option("--damage", metavar="KIND", help="spalls: one that grows; pits: a cluster that grows.")
    ] = "spalls",
    severities: Annotated[int, typer.Option("--severities", metavar="N", help="Sizes of damage, 1 to 12.")] = 3,
    as_json: AsJson = False,
) -> None:
    """Write a short configuration of your own gearbox; at a terminal it asks for what is missing.

    Shafts and bearings are of catalogue sizes for what the gears are rated for, the accuracy of the flanks lets the
    whole face carry; masses follow from the gears, sampling rate and duration from mesh and hunting period, damage from
    the module. The rest comes from the preset bench. `siggen plan` then tries the machine. Editors complete keys by
    the file siggen.schema.json, which is written beside it.

    Example: siggen init --teeth 25,56 --module 2 --speed 1450rpm --out rig.yaml
    """
    from siggen.checks.loading import load_config
    from siggen.checks.notes import covering_classes
    from siggen.checks.plausibility import implausible
    from siggen.config.expert_keys import schema_text
    from siggen.errors import UsageError
    from siggen.file_writing import write_file
    from siggen.keys.yaml_source import parse_yaml
    from siggen.rig.rig_answers import QUESTIONS, missing_answers, refuse_missing, rig_of
    from siggen.rig.rig_text import SCHEMA_FILE, rig_text

    if out.exists():
        raise UsageError(f"{out}: is there already; give --out a new file")
    answers = {name.replace("_", "-"): said for name, said in asdict(numbers).items()}
    if not sys.stdin.isatty():
        refuse_missing(missing_answers(answers))
    for option in missing_answers(answers):
        answers[option] = str(typer.prompt(QUESTIONS[option]))
    rig, proposals = rig_of(answers, sensors, damage=damage, severities=severities)
    rig = replace(rig, accuracy_classes=covering_classes(rig))
    text = rig_text(rig, _name(out), proposals)
    design = load_config(parse_yaml(text, str(out)))  # what is refused is never written
    write_file(out.with_name(SCHEMA_FILE), schema_text())
    write_file(out, text)  # last: once it is there, this command refuses
    doubts = [*implausible(design.possible)]
    if as_json:
        echo_json({"path": str(out), "proposed": proposals, "implausible": doubts})
        return
    for option, sentence in proposals.items():
        echo(f"--{option} was not given; proposed: {sentence}", err=True)
    for sentence in doubts:
        echo(f"implausible: {sentence}", err=True)
    echo(f"next: siggen plan {out} (tries it: which records would be lost); siggen generate {out} ...", err=True)
    echo(str(out))


def _name(out: Path) -> str:
    """Return the file's name as the name of a set: letters, digits, '.', - and _."""
    kept = (c if c.isascii() and (c.isalnum() or c in ".-_") else "_" for c in out.stem)
    return "".join(kept).lstrip("._-") or "rig"
