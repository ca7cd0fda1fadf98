"""Tooth geometry, damage and mesh stiffness."""

from __future__ import annotations

from siggen.gears.compliance import ToothCompliance, tooth_compliance
from siggen.gears.contact_zones import ContactZone, contact_zones
from siggen.gears.damage import Damage, DamageProblem, Pit, Spall, axial_height, damage_problems
from siggen.gears.foundation import outside_foundation_fit
from siggen.gears.geometry import GearPair, GeometryProblem, SpurGear, geometry_problems
from siggen.gears.layouts import clustered_centres, layered_centres
from siggen.gears.outlines import Ellipse, Polygon, rectangle, v_outline
from siggen.gears.sections import contact_length_loss, section_loss, union_area_m2
from siggen.gears.stiffness import PairCompliance, mesh_stiffness, pair_compliance, pair_stiffness
from siggen.gears.stiffness_notes import stiffness_notes
from siggen.gears.stiffness_options import StiffnessOptions
from siggen.gears.summary import DamageSummary, damage_summary
from siggen.gears.tables import MeshTables, largest_stiffness_loss, mesh_tables, table_error

__all__ = [
    "ContactZone",
    "Damage",
    "DamageProblem",
    "DamageSummary",
    "Ellipse",
    "GearPair",
    "GeometryProblem",
    "MeshTables",
    "PairCompliance",
    "Pit",
    "Polygon",
    "Spall",
    "SpurGear",
    "StiffnessOptions",
    "ToothCompliance",
    "axial_height",
    "clustered_centres",
    "contact_length_loss",
    "contact_zones",
    "damage_problems",
    "damage_summary",
    "geometry_problems",
    "largest_stiffness_loss",
    "layered_centres",
    "mesh_stiffness",
    "mesh_tables",
    "outside_foundation_fit",
    "pair_compliance",
    "pair_stiffness",
    "rectangle",
    "section_loss",
    "stiffness_notes",
    "table_error",
    "tooth_compliance",
    "union_area_m2",
    "v_outline",
]
