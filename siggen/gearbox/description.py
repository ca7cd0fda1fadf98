"""A design in words: which faults it has, and how its set was made; nothing that it does not use, all that it does."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import fill
from typing import TYPE_CHECKING, TypeAlias

from siggen.config.changes import Change
from siggen.config.dynamics import oils_of
from siggen.config.inheritance import REPLACED, REPLACED_OF_DYNAMICS
from siggen.damage.registry import HEALTHY
from siggen.errors import Problem, counted
from siggen.gearbox.design import STATING
from siggen.gearbox.life import SEVERITIES
from siggen.gearbox.mode_table import mode_table
from siggen.keys.distributions import DRAWN
from siggen.keys.section import Section
from siggen.names import SEVERAL
from siggen.sensors.converter import FROM_NOISE

if TYPE_CHECKING:
    from siggen.config import Config, StateSection
    from siggen.gearbox.design import SetDesign


WIDTH = 118
STIFFNESS_DAMAGE = "remove material from the tooth's sections and shorten the contact line: the mesh loses stiffness."
GEOMETRY_DAMAGE = (
    "act as geometry: the lands beside them go on carrying, and where no land is left the mating flank sinks until it "
    "rests on the edges (`sink_depth_um`). {sections} `mesh_stiffness_loss` is a measure of the damage by potential "
    "energy, which this simulation does not use; `mesh_stiffness_loss_as_simulated` says what it does use."
)
SECTIONS = {
    "geometry": "The tooth's sections keep their strength.",
    "all": "They also take material from the tooth's sections, which weakens them.",
}
GROWTH = (
    "States of a specimen may grow from each other: a later state then keeps the damage of the earlier one "
    "(`grows` in `config.yaml`). Single damages are in `damage/`."
)
FRICTION = {
    "off": "There is no friction between the flanks.",
    "constant": "The flanks rub with a constant coefficient.",
    "mixed_ehl": "The flanks rub: asperities and the film of {oil} share the load by speed, load and roughness.",
}
BACKGROUND = {
    "rubbing": "rubbing of rough flanks",
    "bearings": "noise of its rolling bearings",
    "machines": "noise of motor and load",
    "shafts": "lines of its shafts",
    "second_stage": "a second gear stage",
    "auxiliary_drive": "an auxiliary drive",
}
"""Part of `background` -> what it adds."""

CHANGED = "A state that changes keys is the healthy gearbox with the same draws, but for these keys (`changed_keys`)."

LIVES = (
    "Every gearbox is new at its first inspection and runs until a tooth fails, or until it is taken out. Pits begin, "
    "grow and spread by the law of siggen.life.pitting; between two inspections damage never shrinks."
)


PERFECT_GEARS = """* **The gears have no manufacturing errors.** A healthy gearbox here has no sidebands around its mesh
  harmonics except those of the noise, so healthy and faulty separate trivially, by almost any indicator. Do not read a
  detection score on this set as one for real gearboxes, where pitch errors and run-out raise the same sidebands.
  What the set can teach: the shape, order and growth of fault signatures, effects of speed, load, noise and position,
  and whether a processing chain finds a signature that is known to be there.
"""
TOLERANCES = """* **Gears have manufacturing errors** within flank tolerance class {classes} of ISO 1328-1
  (share used: {share}), every tooth its own: healthy records have sidebands too. {owner}
"""
OWNERS = {
    "specimen": "All states of a specimen have the same gears, as on a rig before and after damage, so a difference "
    "between\n  its states is the damage.",
    "state": "Every state of a specimen has gears of its own from the same drawing, so no difference between states is "
    "the\n  damage alone.",
}


def making(design: SetDesign) -> str:
    """Return the section `How it was made` of a set's card."""
    config = design.config
    steps = (
        f"1. **Gears.** {_gears_text(config)}",
        f"2. **Damage.** {damage_text(config)}",
        f"3. **Dynamics.** {_dynamics_text(config)}",
        f"4. **Sensing.** {_sensing_text(config)}",
    )
    listed = "\n".join(fill(step, WIDTH, subsequent_indent="   ", break_on_hyphens=False) for step in steps)
    return f"## How it was made\n\n{listed}\n\n{_states_text(config)}\n"


def faults(design: SetDesign) -> tuple[str, ...]:
    """Return the kinds of fault of a set, in the order of its states; none of a set of healthy gearboxes."""
    config = design.config
    if config.life is not None:
        return tuple(section.words[0] for section in config.damages)
    return tuple(dict.fromkeys(state.fault for state in config.states if state.faulty))


def faults_text(design: SetDesign) -> str:
    """Return the kinds of fault as the words of a title."""
    *first, last = faults(design) or ("healthy gears alone",)
    return f"{', '.join(first)} and {last}" if first else last


def class_words(design: SetDesign) -> dict[str, tuple[str, ...]]:
    """Return the labels that are classes, each with its words in the order of their numbers."""
    config = design.config
    words = {"fault": (HEALTHY, *faults(design)), "severity": SEVERITIES}
    if config.life is None:
        words = {key: tuple(dict.fromkeys(getattr(state, key) for state in config.states)) for key in words}
    gears = ("none", *(gear.word for gear in config.names.gears), SEVERAL)
    return {"state": config.state_names, **words, "faulty_gear": gears}


def machine_word(design: SetDesign) -> str:
    """Return what its gearboxes are called."""
    config = design.config
    if config.machine is not None:
        return "gearbox"
    if config.planetary is not None:
        return "planetary gear set"
    return "spur gear pair" if config.gears.helix_deg == 0.0 else "helical gear pair"


def tolerances_text(design: SetDesign) -> str:
    """Say what follows from the gears being perfect, or how far they are from it."""
    section = design.config.manufacture
    if section is None:
        return PERFECT_GEARS
    return TOLERANCES.format(classes=section.classes_text, share=section.tolerance_share, owner=OWNERS[section.draw])


def _states_text(config: Config) -> str:
    """List the states; inspections have no list, since every gearbox has its own."""
    if config.life is None:
        return "\n".join(["States:\n", *map(_state_text, config.states)])
    return (
        "A state is one inspection of one life: the same number is another damage in another gearbox. Ages, phases\n"
        "and remaining lives are in `life/`."
    )


def _state_text(state: StateSection) -> str:
    return "; ".join([f"* `{state.name}`: fault {state.fault}, severity {state.severity}", *state.remarks])


def _gears_text(config: Config) -> str:
    models = f"`{config.stiffness.beam}`, `sainsot`"
    return (
        f"{_teeth_text(config)} Mesh stiffness by the "
        f"potential energy method (bending, shear, axial compression, Hertz contact, tooth foundation: {models}), "
        "along the true involute and double-tooth contact."
    )


def _teeth_text(config: Config) -> str:
    gears = config.gears
    if config.planetary is not None:
        return _planetary_text(config)
    if config.machine is not None:
        return _machine_text(config)
    if not gears.pairs:
        return f"A spur pair with {gears.pinion.teeth} and {gears.gear.teeth} teeth."
    (least, most), (low, high) = (_ends(gears.teeth_of(which)) for which in ("pinion", "gear"))
    small, large = _ends([pair.module_mm for pair in gears.pairs])
    return (
        f"{len(gears.pairs)} spur pairs, with {least} to {most} and {low} to {high} teeth of module {small:g} to "
        f"{large:g} mm; every gearbox has one of them (`pair`), and masses, supports, torque and damage of its size. "
        f"Splits never share a {config.splits.by}."
    )


def _machine_text(config: Config) -> str:
    """Say which gears mesh, by the names of the user."""
    pairs = (config.gears, *(stage.gears for stage in config.stages))
    meshes = [
        f"`{mesh.word}`, in which {mesh.driver.word} with {pair.pinion.teeth} teeth drives {mesh.driven.word} with "
        f"{pair.gear.teeth}"
        for mesh, pair in zip(config.names.meshes, pairs, strict=True)
    ]
    return f"Spur gears in the order of power: {'; '.join(meshes)}; all meshes are simulated together."


def _planetary_text(config: Config) -> str:
    """Say which teeth a planetary set has, and where its planets stand."""
    assert config.planetary is not None
    sun, planet, places = config.gears.pinion.teeth, config.gears.gear.teeth, config.planetary.positions_deg
    return (
        f"A planetary set: a sun with {sun} teeth drives {len(places)} planets with {planet} in a ring with "
        f"{config.planetary.ring_teeth} that is held; the planets stand at {', '.join(f'{p:g}' for p in places)} "
        "degrees on the carrier, which drives the load."
    )


def _ends(values: Sequence[float]) -> tuple[float, float]:
    return min(values), max(values)


def damage_text(config: Config) -> str:
    """Say how the kinds of damage act on the teeth."""
    if config.life is not None:
        return LIVES
    shown = (section for state in config.states if state.damaged for section in state.damages)
    kinds = list(dict.fromkeys(type(section) for section in shown))
    changed = [CHANGED] if any(state.changes for state in config.states) else []
    if not kinds:
        return " ".join(["No teeth are damaged.", *changed] if changed else ["None: every state is healthy."])
    nouns = list(dict.fromkeys(noun for kind in kinds if kind.nouns for noun in kind.nouns.split(" and ")))
    said = [_flank_text(config, " and ".join(nouns))] if nouns else []
    return " ".join([*said, *dict.fromkeys(kind.acts for kind in kinds if kind.acts), GROWTH, *changed])


def _flank_text(config: Config, nouns: str) -> str:
    """Say how material missing from a flank acts."""
    mesh = config.dynamics.mesh
    acts = STIFFNESS_DAMAGE if mesh.law == "linear" else GEOMETRY_DAMAGE.format(sections=SECTIONS[mesh.damage])
    head = f"{nouns.capitalize()} with outline, depth and place on the flank {acts}"
    return f"{head} The union of overlapping outlines counts once."


def _dynamics_text(config: Config) -> str:
    mesh = "a mesh with backlash, time-varying stiffness and damping"
    if config.dynamics.mesh.law == "pairs":
        mesh = "a mesh of single tooth pairs with backlash, stiffness, tip relief and damping"
    return (
        f"A lumped gearbox (`{config.dynamics.model}`): motor, load, shafts, bearings, and {mesh}. "
        f"{across_text(config)}{friction_text(config)} {drive_text(config)} What sensors see is low-pass "
        f"filtered before it is sampled. {integration_text(config)}"
    )


def integration_text(config: Config) -> str:
    """Say how time is stepped, and which error is stated for it."""
    dynamics, head = config.dynamics, f"Time is stepped by `{config.dynamics.method}`"
    if dynamics.method != STATING:
        return f"{head}, {counted(dynamics.steps_per_sample, 'step')} per sample; no error is stated for it."
    return (
        f"{head}, with steps for a relative rms error of {dynamics.integration_tolerance:g} in the delivered "
        "signals, the same for all states of a gearbox; `siggen verify --physics` measures it."
    )


def _sensing_text(config: Config) -> str:
    return (
        f"{_path_text(config)}{background_text(config)}Gain, noise, clipping at the sensor's "
        "range, and rounding to the converter's step, which is a power of two and therefore exact in float32"
        f"{_steps_text(config)}." + "".join(f" {acts}" for acts in _acts(config))
    )


def _steps_text(config: Config) -> str:
    """Return the steps of all converters, each with the sensors that have it."""
    sensors: dict[str, list[str]] = {}
    for one in config.sensors:
        of_noise = ", at most a fifth of the noise floor" if one.bits == FROM_NOISE else ""
        step = f"{one.converter_step:.3g} {one.quantity.unit}{of_noise}" if one.converter_step else "none"
        sensors.setdefault(step, []).append(f"`{one.name}`")
    listed = "; ".join(f"{', '.join(names)}: {step}" for step, names in sensors.items())
    return f" ({listed})"


def _acts(config: Config) -> list[str]:
    """Say how kinds of sensors read the model that need saying."""
    return list(dict.fromkeys(one.acts for one in config.sensors if one.acts))


def across_text(config: Config) -> str:
    """Say what the contact and the shafts know of the face width."""
    if config.dynamics.mesh.law == "linear":
        return ""
    solved = "The contact is solved across the face and depends on the load (`dynamics.mesh.law: pairs`). "
    return solved + ("Shafts bend and gears tilt (`dynamics.shafts`). " if config.dynamics.shafts is not None else "")


def friction_text(config: Config) -> str:
    """Say whether and how the flanks rub."""
    return FRICTION[config.dynamics.rubbing].format(oil=" or ".join(oils_of(config.dynamics.friction.oil)))


def drive_text(config: Config) -> str:
    """Say what of speed and torque varies within a record."""
    varied = config.variation
    moving = [name for name in ("speed", "torque") if getattr(varied, name) != type(getattr(varied, name))()]
    if not moving:
        return "Speed and torque are constant within a record."
    still = {"speed": "the torque is constant", "torque": "the speed is constant"}
    rest = f"; {still[moving[0]]}" if len(moving) == 1 else ""
    return f"Within a record {' and '.join(moving)} {'vary' if len(moving) > 1 else 'varies'} (`variation`){rest}."


def _path_text(config: Config) -> str:
    """Say how vibrations come to the sensors."""
    measured = [sensor.name for sensor in config.sensors if sensor.through is not None]
    behind = f"{_some(measured, config)} stand behind a measured accelerance (`path`). " if measured else ""
    shown = len(measured) < len(config.sensors) and config.gives_way
    return (_housing_text(config) if shown else "") + behind


def _housing_text(config: Config) -> str:
    through = "Bearing forces reach the sensors through"
    if config.housing.kind != "modal":
        return f"{through} a box of plates on bolts, new for every specimen (`housing`). "
    modes = counted(mode_table(config.housing.modes).frequency_hz.size, "mode")
    return f"{through} a housing of which {modes} were given, the same for every specimen (`housing.modes`). "


def _some(names: list[str], config: Config) -> str:
    if len(names) == len(config.sensors):
        return "All sensors"
    return f"{counted(len(names), 'sensor')} of {len(config.sensors)}"


def background_text(config: Config) -> str:
    """Say what a healthy machine adds to its gears, and whose the levels are."""
    section = config.background
    if section is None:
        return ""
    parts = [said for name, said in BACKGROUND.items() if getattr(section, name) is not None]
    if not parts:
        return ""
    listed = " and ".join(part for part in (", ".join(parts[:-1]), parts[-1]) if part)
    return f"A healthy machine adds {listed} (`background`); the levels belong to the gearbox. "


# Sections of a published card: what physics is on and off, and where every number comes from.

NOT_NUMBERS = ("name", "seed", "specimens", "kind")
_Row: TypeAlias = tuple[str, str, str, bool]
"""Key, value, meaning and whether it is the default."""


def physics_section(design: SetDesign) -> str:
    """Return a table of what the simulation of this set has and has not."""
    lines = [f"| {what} | {'on' if on else 'off'} | {how} |" for what, on, how in _physics(design.config)]
    return "\n".join(["## Physics that is on and off", "", "| what | | how |", "|---|---|---|", *lines, ""])


def _physics(config: Config) -> Iterator[tuple[str, bool, str]]:
    dynamics, mesh, made = config.dynamics, config.dynamics.mesh, config.manufacture
    paths = [sensor for sensor in config.sensors if sensor.through is not None]
    yield (
        "manufacturing errors of the teeth",
        made is not None,
        f"ISO 1328-1 class {made.classes_text}" if made else "perfect gears",
    )
    yield "tooth pairs one by one", mesh.law == "pairs", f"`dynamics.mesh.law: {mesh.law}`"
    yield "contact across the face, damage as geometry", mesh.law == "pairs", f"`dynamics.mesh.law: {mesh.law}`"
    yield "friction of the flanks", dynamics.rubbing != "off", friction_text(config)
    yield "casing that moves", dynamics.model == "casing", f"`dynamics.model: {dynamics.model}`"
    yield "shafts that bend, gears that tilt", dynamics.shafts is not None, "`dynamics.shafts`"
    yield "unbalance", dynamics.unbalance != type(dynamics.unbalance)(), "`dynamics.unbalance`"
    yield "variation within a record", config.variation != type(config.variation)(), drive_text(config)
    yield "housing that gives way", config.gives_way, "`housing`"
    yield "measured path to the sensors", bool(paths), f"{len(paths)} of {len(config.sensors)} sensors"
    yield "background of a healthy machine", config.background is not None, "`background`"


def assumed_numbers_section(design: SetDesign) -> str:
    """Return every number of the configuration with who chose it; none was fitted to the records.

    A default says nothing about any machine: it is what siggen takes where nobody says otherwise.
    """
    config = design.config
    rows = list(_own(config) if config.machine is not None else _numbers("", config))
    chosen = sum(from_default is False for *_, from_default in rows)
    chosen_by = {True: "default", False: "configuration"}
    lines = [f"| `{path}` | {value} | {chosen_by[default]} | {meaning} |" for path, value, meaning, default in rows]
    head = (
        f"## Where the numbers come from\n\n{chosen} numbers and choices were set in the configuration; "
        f"{len(rows) - chosen} are defaults of siggen. Both are assumptions: no number was fitted to these records. A "
        "range is drawn anew for every gearbox. What the defaults rest on is said in the documentation of siggen "
        "(docs/reference/yaml.md).\n"
    )
    return "\n".join([head, "| key | value | chosen by | meaning |", "|---|---|---|---|", *lines, ""])


def _own(config: Config) -> Iterator[_Row]:
    """Yield the rows of a machine in the words of its file."""
    names = config.names
    for path, value, meaning, default in _numbers("", config):
        parts = path.split(".")
        if parts[0] in REPLACED or (parts[0] == "dynamics" and parts[1] in REPLACED_OF_DYNAMICS[:2]):
            continue
        yield names.problem(Problem(path, "", "")).path, value, meaning, default


def _numbers(path: str, section: Section) -> Iterator[_Row]:
    """Yield path, value, meaning and whether it is the default of every leaf of a section."""
    for name, field in type(section).model_fields.items():
        value = getattr(section, name)
        below = f"{path}.{name}" if path else name
        items = value if isinstance(value, tuple) and value and all(isinstance(item, Section) for item in value) else ()
        if (name in NOT_NUMBERS and not path) or name == section.key_field or field.exclude:
            continue
        if items:
            for place, item in enumerate(items):
                if isinstance(item, Change):
                    yield f"{below}.{item.path}", f"{item.how} {item.value}", str(field.description), False
                else:
                    yield from _numbers(f"{below}.{getattr(item, item.key_field or '', place)}", item)
        elif isinstance(value, Section) and not isinstance(value, DRAWN) and "kind" not in type(value).model_fields:
            yield from _numbers(below, value)
        else:
            default = not field.is_required() and value == field.get_default(call_default_factory=True)
            yield below, _text(value), str(field.description or ""), default


def _text(value: object) -> str:
    if isinstance(value, Section) and not isinstance(value, DRAWN):
        parts = value.model_dump()
        kind = parts.pop("kind", "")
        told = [f"{key} {_text(part)}" for key, part in parts.items() if part is not None]
        return f"{kind} {', '.join(told)}".strip()[:120]
    text = "none" if value is None else f"{value:g}" if isinstance(value, float) else str(value)
    return (text if len(text) <= 120 else f"{text[:117]}...").replace("|", "/").replace("\n", " ")
