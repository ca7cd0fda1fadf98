"""Section `dynamics`: inertias, supports and couplings of the gearbox, and how its motion is integrated."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, TypeAlias, get_args

from pydantic import Field, model_validator

from siggen.damage.ball_geometry import BallGeometry
from siggen.errors import Problem
from siggen.keys.distributions import Uniform
from siggen.keys.number import Each, Number, Within
from siggen.keys.parser import Parser
from siggen.keys.problems import nearest_word, received_text, refusal
from siggen.keys.section import Section, Whole
from siggen.keys.usual import Usual
from siggen.keys.wording import AllowedText
from siggen.names import SHAFT_OF

# Which oil a gearbox runs in: one for the whole set, or a list from which each gearbox draws.

OilName: TypeAlias = Literal[
    "ISO VG 32", "ISO VG 46", "ISO VG 68", "ISO VG 100", "ISO VG 150", "ISO VG 220", "ISO VG 320", "ISO VG 460",
    "ISO VG 680",
]  # fmt: skip
OIL_NAMES: tuple[str, ...] = get_args(OilName)
OilValue = str | tuple[str, ...]


class OilParser(Parser):
    """Parser of `oil`: a name, or a list of different names."""

    allowed_text = f"one of {', '.join(OIL_NAMES)}, or a list of some, from which each gearbox draws"
    documented: Any = OilName | Annotated[list[OilName], Field(min_length=1)]

    def parse(self, value: object) -> OilValue:
        """Return a name or several, or raise a refusal."""
        if isinstance(value, str) and value in OIL_NAMES:
            return value
        if isinstance(value, (list, tuple)):
            names = [name for name in value if isinstance(name, str) and name in OIL_NAMES]
            if names and len(names) == len(value) == len(set(names)):
                return tuple(names)
        meant = nearest_word(value, OIL_NAMES)
        raise refusal([Problem("", received_text(value), f"allowed: {self.allowed_text}{meant}")])


Oil = Annotated[OilValue, OilParser()]


def oils_of(oil: OilValue) -> tuple[str, ...]:
    """Return the oils that a gearbox may have."""
    return oil if isinstance(oil, tuple) else (oil,)


# Sections `dynamics.mesh` and `dynamics.friction`: how the teeth push and rub.

DAMPING_PARTS = "parts with damping: asperity_share: always there, in a full oil film, where asperities carry all"


class MeshSection(Section):
    """The law of the mesh force; everything but `law` is used by the law pairs alone."""

    law: Literal["linear", "pairs"] = Field(
        default="pairs",
        description="linear: mesh stiffness times approach (paper A); pairs: each tooth pair by itself, its "
        "contact solved across the face",
    )
    tip_relief_um: Annotated[Number, Within(least=0)] = Field(default=8.0, description="parabolic, of both gears")
    tip_relief_pitches: Annotated[Number, Within(above=0, most=1), Usual(0.1, 0.8)] = Field(
        default=0.25, description="its length along the line of action, in base pitches"
    )
    damage: Literal["all", "geometry"] = Field(
        default="all",
        description="of law pairs; geometry: lands carry, flanks sink where none is left, neighbouring land "
        "is rough; all: weaker sections too",
    )
    pit_edge_radius_mm: Annotated[Number, Within(least=0, most=1), Usual(0.005, 1)] = Field(
        default=0.1, description="rounding of the edges of damage (law: pairs)"
    )
    damping: Literal["constant", "asperity_share"] = Field(
        default="constant",
        description="constant: mesh_damping_ratio; asperity_share: structure + film (1 - La) + asperities La, "
        "with La of friction.model: mixed_ehl",
    )
    structure_damping_ratio: Annotated[Number, Within(least=0, most=0.5), Usual(0.002, 0.3)] = Field(
        default=0.04, description=DAMPING_PARTS
    )
    film_damping_ratio: Annotated[Number, Within(least=0, most=0.5), Usual(0.002, 0.3)] = Field(
        default=0.02, description=DAMPING_PARTS
    )
    asperity_damping_ratio: Annotated[Number, Within(least=0, most=0.5), Usual(0.002, 0.3)] = Field(
        default=0.05, description=DAMPING_PARTS
    )


class Friction(Section):
    """Friction between the flanks; needs the law pairs."""

    model: Literal["auto", "off", "constant", "mixed_ehl"] = Field(
        default="auto",
        description="mixed_ehl: asperities and oil film share the load; auto: mixed_ehl with the law pairs, else off",
    )
    coefficient: Annotated[Number, Within(least=0, most=0.5), Usual(0.005, 0.3)] = Field(
        default=0.05, description="of the model constant"
    )
    oil: Oil = Field(default="ISO VG 220", description="mineral gear oil (mixed_ehl); of a list each gearbox draws one")
    oil_temperature_c: Annotated[Number | None, Within(least=-20, most=150, words=(None,)), Usual(5, 120)] = Field(
        default=None,
        description="at the inlet of the contact; null: by the losses, up to 90, where a cooler holds it",
    )
    boundary_friction: Annotated[Number, Within(least=0, most=0.5), Usual(0.02, 0.3)] = Field(
        default=Uniform(low=0.07, high=0.11), description="coefficient of asperities, by the oil's additives"
    )
    roughness_um: Annotated[Number, Within(above=0, most=5)] = Field(
        default=Uniform(low=0.2, high=0.5), description="rms roughness of either flank, run in (mixed_ehl)"
    )
    pit_roughness_um: Annotated[Number, Within(above=0, most=5), Usual(0.1, 5)] = Field(
        default=2.0,
        description="rms, in damage and on land up to its width and 0.5 mm from it (mixed_ehl)",
    )


SIZED_TEXT = "null: by rated_torque_nm"


class ShaftSection(Section):
    """A round steel shaft of one diameter on two bearings, with its gear between them."""

    bearing_span_mm: Annotated[Number | None, Within(above=0, most=2000, words=(None,))] = Field(
        default=100.0, description="distance of the bearings; " + SIZED_TEXT
    )
    gear_position: Annotated[Number, Within(above=0, below=1)] = Field(
        default=0.5, description="middle of the gear from one bearing over the span"
    )
    diameter_mm: Annotated[Number | None, Within(least=5, words=(None,))] = Field(
        default=25.0, description="of the shaft; " + SIZED_TEXT
    )


class Shafts(Section):
    """Shafts of both gears; bearing stiffnesses of these shafts are those of both bearings."""

    driver: ShaftSection = Field(default=ShaftSection(), description="shaft of the driving gear")
    driven: ShaftSection = Field(default=ShaftSection(), description="shaft of the driven gear")

    def of(self, role: str) -> ShaftSection:
        """Return the shaft of the pinion or of the gear."""
        shaft: ShaftSection = getattr(self, SHAFT_OF[role])
        return shaft


class UnbalanceSection(Section):
    """Residual unbalance of both shafts by balance quality grade; its phase is drawn per specimen."""

    grade_mm_s: Annotated[Number, Within(least=0, most=100), Usual(0.05, 100)] = Field(
        default=0.0,
        description="eccentricity times speed at 50 Hz of the input shaft: 6.3 for G6.3",
    )


MACHINE = "of the machine that drives, or is driven"
RATED = "rated_torque_nm"
"""Key from which the sizes follow that a file leaves out."""
RATED_LOAD = (
    "of the first shaft: masses, inertias, bearings, couplings and shafts left out follow from both; torque "
    "null: own defaults, speed null: the highest"
)
RATED_SPEED = "rated_speed_hz"
RATED_SPEED_TEXT = AllowedText("a number above 0 up to 1e+05, or null")
RATED_TEXT = AllowedText("a number above 0 up to 1e+06, or null")


ACROSS = (
    "across the shaft, damping of 2 to 7 % of critical for shafts of 3 to 0.3 kg; {each: [horizontal, vertical]}: one "
    f"for each; damping_time_s: damping over stiffness at any load, in place of damping; {SIZED_TEXT}"
)


DAMPING, TIME = "damping_n_s_per_m", "damping_time_s"


class BearingSection(Section):
    """Both bearings of a shaft together; each direction draws its own number."""

    stiffness_n_per_m: Annotated[Number | Each | None, Within(above=0, each=True, count=2, words=(None,))] = Field(
        default=2e8, description=ACROSS
    )
    damping_n_s_per_m: Annotated[Number | Each | None, Within(least=0, each=True, count=2, words=(None,))] = Field(
        default=1000.0, description=ACROSS
    )
    damping_time_s: Annotated[Number | None, Within(least=0, words=(None,)), Usual(5e-7, 2e-4)] = Field(
        default=None, description=ACROSS
    )
    axial_stiffness_n_per_m: Annotated[Number, Within(above=0), Usual(1e06, 2e09)] = Field(
        default=1e8, description="along the shaft, where helical teeth push"
    )
    geometry: BallGeometry | None = Field(
        default=None,
        description="given: two such ball bearings, whose stiffness follows load and clearance; null: the "
        "stiffness above",
    )

    @model_validator(mode="before")
    @classmethod
    def _one_damping(cls, value: Any) -> Any:
        """Let a damping over stiffness stand for the default damping; refuse it beside a given one."""
        if not isinstance(value, Mapping) or value.get(TIME) is None:
            return value
        if value.get(DAMPING) is None:
            return {**value, DAMPING: None}
        other = received_text(value[DAMPING])
        allowed = f"allowed: one of both; the other one null, such as {DAMPING}: null"
        raise refusal([Problem(TIME, f"{received_text(value[TIME])}, beside {DAMPING} {other}", allowed)])

    @property
    def nulls(self) -> list[str]:
        """Keys that leave a number to a rated torque."""
        found = ["stiffness_n_per_m"] if self.stiffness_n_per_m is None else []
        return [*found, "damping_n_s_per_m"] if self.damping_n_s_per_m is self.damping_time_s is None else found


OF_ROTOR = (
    "null: a solid steel disc of the pitch circle with its bore, turning about its shaft; with rated_torque_nm, its "
    "shaft too"
)


class RotorSection(Section):
    """Mass of a gear, what makes it wobble, and the bearings of its shaft (x along the centre line, y vertical)."""

    mass_kg: Annotated[Number | None, Within(above=0, words=(None,))] = Field(default=None, description=OF_ROTOR)
    inertia_kg_m2: Annotated[Number | None, Within(above=0, words=(None,))] = Field(default=None, description=OF_ROTOR)
    eccentricity_um: Annotated[Number, Within(least=0, most=200), Usual(0.5, 200)] = Field(
        default=0.0,
        description="of the gear's axis from its shaft's, added to what its accuracy class allows; needs manufacture",
    )
    bearing: BearingSection = Field(default=BearingSection(), description="what its shaft turns in")


class CouplingSection(Section):
    """Torsional spring and damper between a gear and the machine on its shaft."""

    stiffness_nm_per_rad: Annotated[Number, Within(above=0)] = Field(default=6300.0, description="torsional stiffness")
    damping_nm_s_per_rad: Annotated[Number, Within(least=0)] = Field(default=0.0984, description="torsional damping")


class OutputCoupling(CouplingSection):
    """The same for the longer shaft to the driven machine; 5 % of critical between the inertias of a small stage."""

    stiffness_nm_per_rad: Annotated[Number, Within(above=0)] = Field(default=2100.0, description="torsional stiffness")
    damping_nm_s_per_rad: Annotated[Number, Within(least=0)] = Field(default=0.286, description="torsional damping")


class Dynamics(Section):
    """The gearbox as a system of rigid bodies on springs."""

    model: Literal["8dof", "casing"] = Field(
        default="casing", description="which bodies move; 8dof: gears, motor, load; casing: the `housing` too"
    )
    steps_per_sample: Annotated[Whole, Field(ge=1, le=256)] = Field(
        default=4, description="integration steps per sample (law: linear)"
    )
    integration_tolerance: Annotated[float, Field(ge=1e-5, le=1e-2)] = Field(
        default=1e-3,
        description="relative rms error of the signals, by which steps are chosen (law: pairs)",
    )
    mesh_damping_ratio: Annotated[Number, Within(least=0, below=1), Usual(0.005, 0.3)] = Field(
        default=0.07, description="damping of the teeth in contact over the critical one"
    )
    backlash_um: Annotated[Number, Within(least=0)] = Field(
        default=80.0, description="total play along the line of action"
    )
    motor_inertia_kg_m2: Annotated[Number, Within(above=0)] = Field(default=4e-3, description=MACHINE)
    load_inertia_kg_m2: Annotated[Number, Within(above=0)] = Field(default=1e-2, description=MACHINE)
    pinion: RotorSection = Field(default=RotorSection(), description="the pinion and its shaft")
    gear: RotorSection = Field(default=RotorSection(), description="the gear and its shaft")
    input_coupling: CouplingSection = Field(default=CouplingSection(), description="between motor and the first gear")
    output_coupling: OutputCoupling = Field(default=OutputCoupling(), description="between the last gear and load")
    mesh: MeshSection = Field(default=MeshSection(), description="how the teeth push")
    friction: Friction = Field(default=Friction(), description="how the teeth rub")
    unbalance: UnbalanceSection = Field(default=UnbalanceSection(), description="forces of shafts out of balance")
    shafts: Shafts | None = Field(default=None, description="given: shafts bend and gears tilt (model: casing)")
    rated_torque_nm: Annotated[float | None, Field(gt=0, le=1e6), RATED_TEXT] = Field(
        default=None,
        description=RATED_LOAD,
    )
    rated_speed_hz: Annotated[float | None, Field(gt=0, le=1e5), RATED_SPEED_TEXT] = Field(
        default=None,
        description=RATED_LOAD,
    )

    @model_validator(mode="after")
    def _nulls_follow_from_something(self) -> Dynamics:
        if None not in (self.rated_torque_nm, self.rated_speed_hz):
            return self
        rotors = {"pinion": self.pinion, "gear": self.gear}
        paths = [f"{wheel}.bearing.{key}" for wheel, rotor in rotors.items() for key in rotor.bearing.nulls]
        if self.shafts is not None:
            shafts = {name: self.shafts.of(wheel) for wheel, name in SHAFT_OF.items()}
            lengths = ("bearing_span_mm", "diameter_mm")
            paths += [f"shafts.{n}.{key}" for n, one in shafts.items() for key in lengths if getattr(one, key) is None]
        if paths:
            raise refusal(
                [Problem(path, "null", f"allowed: a number, or null beside dynamics.{RATED}") for path in paths]
            )
        return self

    @property
    def method(self) -> str:
        """The integrator, which the law chooses: product with the linear one, exponential with pairs."""
        return "product" if self.mesh.law == "linear" else "exponential"

    @property
    def rubbing(self) -> str:
        """The friction that `friction.model` stands for: off, constant or mixed_ehl."""
        if self.friction.model != "auto":
            return self.friction.model
        return "off" if self.mesh.law == "linear" else "mixed_ehl"


class ReferenceDynamics(Dynamics):
    """The same section, stepped by the reference in place of what its law chooses; no file can ask for it."""

    @property
    def method(self) -> str:
        """The classical Runge-Kutta method."""
        return "runge_kutta"


def by_reference(dynamics: Dynamics, steps_per_sample: int | None = None) -> Dynamics:
    """Return the section as the reference steps it, with other steps per sample if they are given."""
    values = {name: getattr(dynamics, name) for name in Dynamics.model_fields}
    if steps_per_sample is not None:
        values["steps_per_sample"] = steps_per_sample
    return ReferenceDynamics.model_construct(**values)
