"""`siggen plan`: what a configuration would give, and which records it would lose."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.life_table import cost_summary, cost_text, history_text, life_doubts, life_summary, life_table
from siggen.cli.working import working
from siggen.names import PINION
from siggen.printable import printable

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from siggen.config import Config
    from siggen.gearbox.design import SetDesign
    from siggen.gearbox.possible import PossibleGearbox
    from siggen.sets.trial import SetTrial


WIDEST = 1000
"""Columns of a table that a pipe takes."""
LONGEST_NAME = 16
"""Of a state that stands on one line of a table."""
NOTES = ("size_notes", "stiffness_notes", "torque_notes", "damage_notes", "state_notes", "shaft_notes")
"""Lists of sentences in the summary, in the order in which they are printed."""


def plan(
    config: Annotated[
        Path, typer.Argument(help="YAML file of the set, or a preset such as quickstart.", metavar="CONFIG")
    ],
    overrides: Annotated[
        list[str] | None,
        typer.Option("--set", help="Replace a value, such as gears.module_mm=3.5.", metavar="PATH=VALUE"),
    ] = None,
    trial: Annotated[
        int | None,
        typer.Option(
            "--trial",
            min=0,
            max=1000,
            help="Gearboxes of which short records are simulated, to tell what would be lost and what the set "
            "costs; 0: none. By default a sample of three records, of states evenly spread; of dear "
            "gears one.",
            metavar="N",
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """List records, shards and size of a configuration, what is implausible and what would be lost.

    A record is lost where its motion leaves the model. A sample of short records says which share that is. For every
    state it says how much of the mesh stiffness its damage takes, and whether as much was found in the preset bench.
    `--trial 0` leaves them out.

    Example: siggen plan configs/quickstart.yaml --set specimens=1000 --trial 20
    """
    from dataclasses import asdict

    from rich.console import Console

    from siggen.checks.loading import load_config

    with working("checking the configuration"):
        loaded = load_config(config, overrides or ())
        summary = plan_summary(loaded)
    found = _tried(loaded, trial)
    tried = found.states if found else ()
    summary["cost"] = _cost(loaded, summary, found)
    summary["trial"] = [{**asdict(state), "interval_95": state.interval, "found": state.found} for state in tried]
    if as_json:
        echo_json(summary)
        return
    console = Console()
    console.print(_overview(summary))
    _print_whole(console, _states(summary) if summary["life"] is None else life_table(summary["life"]))
    for sentence in summary["implausible"]:
        console.print(printable(f"implausible: {sentence}"), highlight=False, markup=False, style="yellow")
    for state in summary["states"]:
        for remark in state["remarks"]:
            console.print(printable(f"{state['name']}: {remark}"), highlight=False, markup=False)
    for note in (note for kind in NOTES for note in summary[kind]):
        console.print(printable(f"note: {note}"), highlight=False, markup=False)
    _print_trial(console, found)


def _cost(design: SetDesign, summary: dict[str, Any], tried: SetTrial | None) -> dict[str, Any] | None:
    """Return the CPU hours of a set and how long that is here; None where nothing may be tried."""
    return None if tried is None else cost_summary(tried.cost, summary, design)


def _tried(design: SetDesign, gearboxes: int | None) -> SetTrial | None:
    """Return what short records of some gearboxes lose; a line on stderr tells how far it is."""
    from siggen.cli.working import stepwise
    from siggen.sets import trial
    from siggen.sets.compilation import compilation_text

    if gearboxes == 0:
        return None
    what = "trying short records (--trial 0 leaves this out)"
    if text := compilation_text(design.method, 1):
        echo(text, err=True)
        what = f"compiling, the first time, and {what}"
    with stepwise(what) as progress:
        return trial.trial(design, gearboxes, progress)


def _print_whole(console: Console, table: Table) -> None:
    """Print a table as wide as it is where nobody looks at a terminal: a pipe has no width to cut it at."""
    from rich.console import Console

    (console if console.is_terminal else Console(width=WIDEST)).print(table)


def _print_trial(console: Console, found: SetTrial | None) -> None:
    """Print which share of every state would be lost, and what to do where that is more than a run allows."""
    from rich.table import Column, Table

    from siggen.errors import counted
    from siggen.sets.loss_limit import ALLOWED_LOSS

    if found is None:
        console.print("nothing was tried: --trial 10 simulates short records of ten gearboxes", markup=False)
        return
    tried, most = found.states, counted(max(one.tried for one in found.states), "gearbox", "gearboxes")
    sampled = sum(one.tried > 0 for one in tried)
    where = "every state" if sampled == len(tried) else f"{sampled} of {len(tried)} states"
    title = f"Trial: a short record of {most} in {where}"
    if found.sized:
        title += f"; damage of {counted(found.sized, 'gearbox', 'gearboxes')} in every state"
    heads = ("lost", "95 % of all", "loss of mesh stiffness", "through the face", "found")
    names = Column("state", overflow="fold", min_width=min(LONGEST_NAME, max(len(one.state) for one in tried)))
    table = Table(names, *heads, title=title, title_justify="left")
    for state in tried:
        low, high = state.interval
        damage = ("", "", "")
        if state.found:
            through = f"yes, {state.profile_length_mm:.2g} mm" if state.through_face else "no"
            damage = (_percent(state.stiffness_loss), through, state.found)
        lost = (f"{state.lost} of {state.tried}", f"{low:.0%} to {high:.0%}") if state.tried else ("not tried", "")
        table.add_row(state.state, *lost, *damage)
    _print_whole(console, table)
    for state in (state for state in tried if state.found == "hardly"):
        sentence = (
            f"{state.state}: will hardly be found: {_percent(state.area_share)} of the flank, "
            f"{_percent(state.stiffness_loss)} of the mesh stiffness. In bench as much has an AUC of 0.50 to 0.53 "
            "alone, 0.68 to 0.90 beside a healthy record of the same gearbox. Give it more of the face"
        )
        console.print(printable(sentence), highlight=False, markup=False, style="yellow")
    for state in (state for state in tried if state.share > ALLOWED_LOSS):
        sentence = (
            f"{state.state}: more than {ALLOWED_LOSS:.0%} would be lost, at which `siggen generate` stops "
            f"(--allowed-loss). {state.reason}"
        )
        console.print(printable(sentence), highlight=False, markup=False, style="yellow")


def plan_summary(design: SetDesign) -> dict[str, Any]:
    """Return counts, sizes and ranges of the set that a configuration describes, as JSON would hold them."""
    from siggen.gearbox.plan import (
        SPLITS,
        estimated_bytes,
        shard_count,
        specimen_count,
        specimens_per_shard,
    )

    config = design.config
    specimens = {split: specimen_count(design, split) for split in SPLITS}
    lives, notes = life_summary(design), _notes(design)
    per_state = len(config.operating_points) * config.repeats
    inspections = config.state_count if lives is None else lives["mean_inspections"]
    records = round(config.specimens * inspections) * per_state
    raw_bytes = records * config.samples * 4 * len(config.channels)
    return {
        "name": config.name,
        "identity": config.identity,
        "specimens": config.specimens,
        "pairs": [str(pair) for pair in config.gears.pairs],
        "records": records,
        "channels": list(config.channels),
        "fs_hz": config.fs_hz,
        "duration_s": config.duration_s,
        "signal_hours": records * config.duration_s / 3600,
        "mesh_hz": list(_mesh_range_hz(config)),
        "mesh": config.names.first.word,
        "stages_hz": {name: list(ends) for name, ends in _stage_ranges_hz(config).items()},
        "specimens_of_split": specimens,
        "states": _state_counts(config, specimens),
        "severity_share": _severity_shares(config),
        "life": lives,
        "shards_of_split": {split: shard_count(design, split) for split in SPLITS},
        "specimens_per_full_shard": specimens_per_shard(design, design.specimens),
        "raw_bytes": raw_bytes,
        "estimated_bytes_on_disk": estimated_bytes(design, records),
        **notes,
        "implausible": [*notes["implausible"], *life_doubts(lives)],
    }


def _notes(design: SetDesign) -> dict[str, Any]:
    """Return how it varies, and what a user should know about it, in words."""
    from siggen.checks.notes import (
        damage_notes,
        oil_notes,
        reversal_notes,
        shaft_notes,
        size_notes,
        state_notes,
        torque_notes,
        variation_notes,
    )
    from siggen.checks.plausibility import implausible

    gearbox = design.possible
    notes = {
        "size_notes": [*size_notes(gearbox)],
        "stiffness_notes": _of_every_pair(gearbox, lambda own: own.stiffness_notes),
        "variation": [*variation_notes(gearbox)],
        "torque_notes": [*torque_notes(gearbox), *_of_every_pair(gearbox, reversal_notes)],
        "damage_notes": _of_every_pair(gearbox, damage_notes),
        "state_notes": [*state_notes(gearbox), *oil_notes(gearbox)],
        "shaft_notes": _of_every_pair(gearbox, shaft_notes),
    }
    return {"manufacture": _manufacture(design.config), **notes, "implausible": implausible(gearbox)}


def _of_every_pair(gearbox: PossibleGearbox, notes: Callable[[PossibleGearbox], Iterable[str]]) -> list[str]:
    """Return notes of all gear pairs, each once; where only some have it, with one of them and their number."""
    found: dict[str, list[int]] = {}
    for index, own in enumerate(gearbox.pairs):
        for note in notes(own):
            found.setdefault(note, []).append(index)
    pairs = gearbox.config.gears.pairs
    return [
        note if len(own) == max(1, len(pairs)) else f"{note} (gears.pairs.{own[0]}, {pairs[own[0]]}; {len(own)} in all)"
        for note, own in found.items()
    ]


def _mesh_range_hz(config: Config) -> tuple[float, float]:
    from siggen.config.planetary import set_of
    from siggen.keys.number import bounds

    speeds = [bounds(point.speed_hz) for point in config.operating_points]
    teeth: tuple[float, ...] = config.gears.teeth_of(PINION)
    if config.planetary is not None:
        teeth = (set_of(config.gears, config.planetary).pitches_per_turn,)
    slowest, fastest = config.variation.speed_ratios
    return min(teeth) * min(low for low, _ in speeds) * slowest, max(teeth) * max(high for _, high in speeds) * fastest


def _stage_ranges_hz(config: Config) -> dict[str, tuple[float, float]]:
    """Return the mesh frequencies of the further stages by name."""
    from siggen.config.machine import turned_teeth

    first, ends = config.gears.pinion.teeth, _mesh_range_hz(config)
    return {
        config.names.mesh(stage.name).word: (float(teeth / first) * ends[0], float(teeth / first) * ends[1])
        for stage, teeth in zip(config.stages, turned_teeth(config.gears, config.stages), strict=True)
    }


def _manufacture(config: Config) -> str:
    """Return what is planned for the errors of the teeth, in words."""
    section = config.manufacture
    if section is None:
        return "perfect gears"
    owner = {"specimen": "the same in all states of a gearbox", "state": "drawn anew for each state"}[section.draw]
    across = "; helix slope and form" if section.has_helix else ""
    across += "; crowned" if section.has_crowning else ""
    return (
        f"ISO 1328-1 class {section.classes_text}; share of its tolerances: {section.tolerance_share}{across}; {owner}"
    )


def _state_counts(config: Config, specimens: dict[str, int]) -> list[dict[str, Any]]:
    per_state = len(config.operating_points) * config.repeats
    return [
        {
            "name": state.name,
            "fault": state.fault,
            "severity": state.severity,
            "remarks": list(state.remarks),
            "records_of_split": {split: count * per_state for split, count in specimens.items()},
        }
        for state in config.states
    ]


def _severity_shares(config: Config) -> dict[str, float]:
    # every state has the same number of records, so the shares are those of the states
    severities = [state.severity for state in config.states]
    return {name: severities.count(name) / len(severities) for name in dict.fromkeys(severities)}


def _hertz(low_hz: float, high_hz: float) -> str:
    return f"{low_hz:g} Hz" if low_hz == high_hz else f"{low_hz:.5g} to {high_hz:.5g} Hz"


def _overview(summary: dict[str, Any]) -> Table:
    from rich.table import Table

    from siggen.errors import counted

    table = Table(title=f"Plan of {summary['name']}", show_header=False, title_justify="left")
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    low_hz, high_hz = summary["mesh_hz"]
    rows = {
        "identity": summary["identity"],
        "gearboxes": f"{summary['specimens']:,}  ({_per_split(summary['specimens_of_split'])})",
        **_pair_row(summary),
        "records": f"{_about(summary)}{summary['records']:,} of {summary['duration_s']:g} s at {summary['fs_hz']:g} Hz",
        "channels": ", ".join(summary["channels"]),
        "hours of signal": f"{summary['signal_hours']:.3g}",
        f"mesh of {summary['mesh']}" if summary["mesh"] else "mesh frequency": _hertz(low_hz, high_hz),
        **{f"mesh of {name}": _hertz(*ends) for name, ends in summary["stages_hz"].items()},
        **_balance(summary),
        "errors of the teeth": summary["manufacture"],
        "shards": f"{sum(summary['shards_of_split'].values())}  ({_per_split(summary['shards_of_split'])}), "
        f"{counted(summary['specimens_per_full_shard'], 'gearbox', 'gearboxes')} in a full one",
        **_of_lives(summary),
        "size on disk": f"about {_size(summary['estimated_bytes_on_disk'])}",
        "size of signals": _size(summary["raw_bytes"]),
    }
    if summary["variation"]:
        rows["variation"] = "; ".join(summary["variation"])
    for name, text in rows.items():
        table.add_row(name, text)
    return table


def _of_lives(summary: dict[str, Any]) -> dict[str, str]:
    """Return the history of load of lives, and what a set takes where that was tried."""
    history = history_text(summary["life"]) if summary["life"] else ""
    cost = {"time": cost_text(summary["cost"])} if summary["cost"] else {}
    return {**({"history of load": history} if history else {}), **cost}


def _about(summary: dict[str, Any]) -> str:
    """Return whether the records of lives were counted by proportion."""
    return "about " if summary["life"] and summary["life"]["lives"] < summary["specimens"] else ""


def _balance(summary: dict[str, Any]) -> dict[str, str]:
    """Return the shares of the severities; nothing where they follow from lives."""
    shares = summary["severity_share"]
    return {"class balance": ", ".join(f"{name} {share:.0%}" for name, share in shares.items())} if shares else {}


def _pair_row(summary: dict[str, Any]) -> dict[str, str]:
    """Return how many gear pairs a set has, and the first; nothing for a set of one pair."""
    pairs: list[str] = summary["pairs"]
    if not pairs:
        return {}
    met = f", of which its gearboxes have {summary['specimens']}" if summary["specimens"] < len(pairs) else ""
    return {"gear pairs": f"{len(pairs)}{met}: {'; '.join(pairs[:3])}{'; ...' if len(pairs) > 3 else ''}"}


def _percent(share: float) -> str:
    return f"{100 * share:.0f} %" if share >= 0.1 else f"{100 * share:.2g} %"


def _size(count: int) -> str:
    unit, name = next(((unit, name) for unit, name in ((1e12, "TB"), (1e9, "GB")) if count >= unit), (1e6, "MB"))
    return f"{count / unit:,.3g} {name}"


def _per_split(counts: dict[str, int]) -> str:
    return ", ".join(f"{split} {count:,}" for split, count in counts.items())


def _states(summary: dict[str, Any]) -> Table:
    from rich.table import Table

    splits = list(summary["specimens_of_split"])
    table = Table("state", "fault", "severity", *splits, "all", title="Records", title_justify="left")
    for state in summary["states"]:
        counts = state["records_of_split"]
        cells = [f"{counts[split]:,}" for split in splits]
        table.add_row(state["name"], state["fault"], state["severity"], *cells, f"{sum(counts.values()):,}")
    return table
