"""What a user writes: the YAML file as frozen sections, with ranges, distributions and an identity."""

from siggen.config.background import (
    Background,
    BaseSection,
    Bearings,
    Bursts,
    ForeignMesh,
    Machines,
    Rubbing,
    ShaftLines,
)
from siggen.config.config import BLOCK, Config, OperatingRange, Splits
from siggen.config.dynamics import (
    CouplingSection,
    Dynamics,
    Friction,
    MeshSection,
    RotorSection,
    Shafts,
    ShaftSection,
    UnbalanceSection,
    by_reference,
)
from siggen.config.gears import GearsSection, Pair, Wheel
from siggen.config.housing import BoltsSection, Housing, ModalHousing, PlateHousing, RigidHousing
from siggen.config.inheritance import extended_files, inherited
from siggen.config.internals import Internals
from siggen.config.key_lines import placed
from siggen.config.machine import Stage
from siggen.config.manufacture import Manufacture
from siggen.config.overrides import apply_overrides
from siggen.config.parsing import ParsedConfig, parse
from siggen.config.planetary import Planetary
from siggen.config.presets import config_file
from siggen.config.states import StateSection
from siggen.config.stiffness import Stiffness
from siggen.config.variation import SpeedVariation, TorqueVariationSection, Variation
from siggen.keys.yaml_source import STORED_NUMBERS, parse_yaml, read_yaml, yaml_text

__all__ = [
    "BLOCK",
    "STORED_NUMBERS",
    "Background",
    "BaseSection",
    "Bearings",
    "BoltsSection",
    "Bursts",
    "Config",
    "CouplingSection",
    "Dynamics",
    "ForeignMesh",
    "Friction",
    "GearsSection",
    "Housing",
    "Internals",
    "Machines",
    "Manufacture",
    "MeshSection",
    "ModalHousing",
    "OperatingRange",
    "Pair",
    "ParsedConfig",
    "Planetary",
    "PlateHousing",
    "RigidHousing",
    "RotorSection",
    "Rubbing",
    "ShaftLines",
    "ShaftSection",
    "Shafts",
    "SpeedVariation",
    "Splits",
    "Stage",
    "StateSection",
    "Stiffness",
    "TorqueVariationSection",
    "UnbalanceSection",
    "Variation",
    "Wheel",
    "apply_overrides",
    "by_reference",
    "config_file",
    "extended_files",
    "inherited",
    "parse",
    "parse_yaml",
    "placed",
    "read_yaml",
    "yaml_text",
]
