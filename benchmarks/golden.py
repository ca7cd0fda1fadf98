"""`python -m benchmarks golden`: one short record of every state of every preset, and what moved since it was kept.

`--write` keeps what records are now. Bytes are comparable on the kind of processor that the file names: others round
differently, so there a signal counts as equal within 1e-6 of its rms, and labels are not compared.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import llvmlite.binding
import numpy as np

from benchmarks.shipped import ROOT, shipped
from siggen.columns.record import SimulatedRecord
from siggen.columns.versions import SIMULATION_VERSION
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record
from siggen.sets.drawn import simulated

KEPT = ROOT / "tests" / "golden.json"
PRESETS = (
    "paper_a",
    "paper_b",
    "quickstart",
    "bench",
    "families",
    "confusers",
    "two_stage",
    "planetary",
    "helical",
    "kinds",
)
"""`industrial` is `bench` with longer records; `kinds` has every kind of damage and of sensor, and a run-up."""
KINDS = ROOT / "tests" / "golden_kinds.yaml"
REFUSED = (
    ("paper_a", "gears.pinion.teeth=3"),
    ("paper_a", "gears.gear.module_mm=3"),
    ("paper_a", "gears.pinion.bore_mm=70"),
    ("paper_a", "operating_points=[{speed_hz: 0, torque_nm: 60}]"),
    ("paper_a", "operating_points=[{speed_hz: 30, torque_nm: 1e9}]"),
    ("paper_a", "states.moderate.damage.first_height_mm=30"),
    ("paper_a", "dynamics.steps_per_sample=0"),
    ("paper_a", "sensors={}"),
    ("quickstart", "specimens=0"),
    ("quickstart", "splits={train: 1, validation: 1, test: 1}"),
    ("quickstart", "fs_hz=100"),
    ("quickstart", "duration_s=0"),
    ("quickstart", "sensors.lid.place=roof"),
    ("quickstart", "sensors.lid.bits=3"),
    ("quickstart", "states.slight.damage.face_share=2"),
    ("quickstart", "states.slight.damage.kind=rust"),
    ("quickstart", "dynamics.model=12dof"),
    ("quickstart", "dynamics.shafts.driver.gear_position=1.5"),
    ("quickstart", "manufacture.accuracy_class=0"),
    ("quickstart", "seed=minus"),
    ("helical", "gears.helix_deg=60"),
    ("helical", "gears.pressure_angle_deg=60"),
    ("two_stage", "housing.bolts.positions_mm=[[0, 0]]"),
    ("two_stage", "states.slight.damage.gear=third"),
    ("two_stage", "machine.meshes.slow.direction_deg=1000"),
    ("planetary", "planetary.positions_deg=[0, 10, 20]"),
    ("planetary", "planetary.ring_teeth=79"),
    ("planetary", "states.sun_slight.damage.gear=slow.pinion"),
    ("kinds", "sensors.te.driven_encoder=none"),
    ("kinds", "states.bearing_spall.damage.bearing=motor_bearing"),
)
"""Preset and override whose message is kept word for word."""
DURATION_S = 0.1
SAMPLES = 8
"""Kept of every signal, evenly spread."""
ROUNDING = 1e-6
"""Of the rms: how far processors of different kinds may lie apart."""


class Moved(NamedTuple):
    """One channel (or the labels) of one record: `by` is a share of the rms, None for labels; `names` those labels."""

    preset: str
    state: str
    channel: str
    equal: bool
    by: float | None = None
    names: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """What is printed of it."""
        if self.equal:
            return "equal"
        return f"moved by {self.by:.2g} of rms" if self.by is not None else f"moved: {', '.join(self.names)}"


def records(preset: str) -> Iterator[SimulatedRecord]:
    """Yield a short record of every state of the first gearbox of a preset, at its first operating point."""
    config = shipped(_file(preset), f"duration_s={DURATION_S}")
    found = simulated(config, [_first_record(config, state) for state in range(len(config.config.states))])
    for record in found:
        if not isinstance(record, SimulatedRecord):
            raise RuntimeError(f"{preset}: {record.reason}")
        yield record


def _file(preset: str) -> Path:
    return KINDS if preset == KINDS.stem.removeprefix("golden_") else ROOT / "configs" / f"{preset}.yaml"


def refusals() -> dict[str, str]:
    """Return preset and override -> what is said of it, without the folder of the checkout.

    Raises
    ------
    ValueError
        If one is not refused.
    """
    said = {}
    for preset, override in REFUSED:
        try:
            shipped(_file(preset), override)
        except ConfigError as error:
            said[f"{preset} {override}"] = str(error).replace(f"{ROOT}/", "")
        else:
            raise ValueError(f"{preset} {override}: is not refused; give REFUSED another")
    return said


def compared(numbers: dict[str, Any]) -> Iterator[Moved]:
    """Yield every channel, and the labels, of every state of some presets beside what was kept."""
    kept = json.loads(KEPT.read_text(encoding="utf-8"))
    same_kind = kept["processor"] == processor()
    for preset, found in numbers.items():
        if not has_kept_states(preset, found):
            raise ValueError(f"{preset}: other states than kept; python -m benchmarks golden --write keeps them anew")
        for state, now in found["states"].items():
            before = kept["presets"][preset]["states"][state]
            yield from _channels(preset, state, now["channels"], before["channels"], same_kind)
            if same_kind:
                names = kept["presets"][preset]["labels"]
                yield _labels(preset, state, _named(found["labels"], now), _named(names, before))


def has_kept_states(preset: str, found: dict[str, Any]) -> bool:
    """Whether the states of a preset are those that were kept."""
    kept = json.loads(KEPT.read_text(encoding="utf-8"))["presets"].get(preset, {"states": {}})
    return list(found["states"]) == list(kept["states"])


def write(found: dict[str, Any]) -> None:
    """Keep what the records of these presets are now; others stay as they were kept.

    Raises
    ------
    ValueError
        If others were kept on another kind of processor: one file holds the numbers of one kind.
    """
    before = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {"presets": {}}
    presets = {**before["presets"], **found}
    if len(presets) > len(found) and before["processor"] != processor():
        raise ValueError(f"kept on {before['processor']}, this is {processor()}: write all presets, not some")
    kept = {
        "simulation_version": SIMULATION_VERSION,
        "processor": processor(),
        "presets": presets,
        "refusals": refusals(),
    }
    KEPT.write_text(_text(kept), encoding="utf-8")


def _text(kept: dict[str, Any], indent: str = "") -> str:
    """Return JSON with one line per state, so that a difference of two files names it."""
    if len(indent) == 4:
        return json.dumps(kept)
    inside = indent + " "
    lines = (
        f"{inside}{json.dumps(key)}: {_text(value, inside) if isinstance(value, dict) else json.dumps(value)}"
        for key, value in kept.items()
    )
    return "{\n" + ",\n".join(lines) + f"\n{indent}}}" + ("" if indent else "\n")


def processor() -> str:
    """Return the kind of processor that compiled code is made for."""
    return str(llvmlite.binding.get_host_cpu_name())


def main(arguments: Sequence[str]) -> int:
    """Print the table, or keep what records are now; 1 if something moved."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks golden", description=__doc__)
    parser.add_argument("presets", nargs="*", metavar="preset", help=f"some of {', '.join(PRESETS)}; default: all")
    parser.add_argument("--write", action="store_true", help=f"keep what records are now in {KEPT.relative_to(ROOT)}")
    asked = parser.parse_args(arguments)
    if unknown := [preset for preset in asked.presets if preset not in PRESETS]:
        parser.error(f"received preset {unknown[0]!r}; allowed: {', '.join(PRESETS)}")
    numbers = {preset: numbers_of(preset) for preset in asked.presets or PRESETS}
    # to keep other states than before nothing can be compared
    known = {preset: one for preset, one in numbers.items() if not asked.write or has_kept_states(preset, one)}
    found = list(compared(known))
    for one in found:
        print(f"{one.preset:12} {one.state:16} {one.channel:28} {one.text}")
    moved = sum(not one.equal for one in found)
    said = json.loads(KEPT.read_text(encoding="utf-8")).get("refusals", {})
    others = {case: text for case, text in refusals().items() if text != said.get(case)}
    for case, text in others.items():
        print(f"{case}\n  now {text}\n  was {said.get(case)}")
    print(f"{len(found) - moved} equal, {moved} moved; {len(others)} of {len(REFUSED)} refusals in other words")
    if asked.write:
        write(numbers)
        return 0
    return int(moved > 0 or len(others) > 0)


def _first_record(config: SetDesign, state: int) -> int:
    return next(i for i in range(config.records_per_specimen) if planned_record(config, i).state_id == state)


def numbers_of(preset: str) -> dict[str, Any]:
    """Return what is kept of a preset: digest, rms and samples of every channel, and a digest of every label."""
    states: dict[str, Any] = {}
    labels: list[str] = []
    for record in records(preset):
        labels = sorted({*labels, *record.labels})
        states[str(record.labels["state"])] = {
            "channels": {name: _of_signal(signal) for name, signal in record.channels.items()},
            "labels": {name: _digest(repr(value).encode())[:4] for name, value in record.labels.items()},
        }
    for state in states.values():
        state["labels"] = " ".join(state["labels"].get(name, "-") for name in labels)
    return {"labels": labels, "states": states}


def _of_signal(signal: np.ndarray) -> list[str | float]:
    """Return digest, rms and samples of a signal; float32 keeps nine digits."""
    rms = float(np.sqrt(np.mean(np.square(signal, dtype=np.float64))))
    at = np.linspace(0, signal.size - 1, SAMPLES).astype(int)
    return [_digest(signal.tobytes())[:16], *(float(f"{value:.9g}") for value in (rms, *signal[at]))]


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _channels(preset: str, state: str, now: dict[str, Any], before: dict[str, Any], same_kind: bool) -> Iterator[Moved]:
    for name in dict.fromkeys([*before, *now]):
        if name not in now or name not in before:
            yield Moved(preset, state, name, equal=False, by=float("inf"))
            continue
        (digest, rms, *samples), (kept_digest, kept_rms, *kept) = now[name], before[name]
        by = float(np.abs(np.subtract([rms, *samples], [kept_rms, *kept])).max()) / kept_rms
        yield Moved(preset, state, name, equal=digest == kept_digest if same_kind else by <= ROUNDING, by=by)


def _named(names: Sequence[str], state: dict[str, Any]) -> dict[str, str]:
    return dict(zip(names, state["labels"].split(), strict=True))


def _labels(preset: str, state: str, now: dict[str, str], before: dict[str, str]) -> Moved:
    names = tuple(name for name in sorted({*now, *before}) if now.get(name) != before.get(name))
    return Moved(preset, state, "labels", equal=not names, names=names)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
