"""Columns of the tables of `life/`: gearboxes, inspections, pitted teeth and pits of a set that runs to failure."""

from __future__ import annotations

import pyarrow as pa

from siggen.keys.column import Column

TURNS, HOURS, SHARE, MM, MM2 = "rev", "h", "1", "mm", "mm²"
F64, I32 = pa.float64(), pa.int32()
SPECIMEN = Column("specimen_id", pa.int64(), "", "gearbox")
SPLIT = Column("split", pa.string(), "", "train, validation or test")
GEAR = Column("gear", pa.string(), "", "pinion or gear")
TOOTH = Column("tooth", I32, "", "index of the tooth, from 0")

UNIT_COLUMNS = (
    SPECIMEN,
    SPLIT,
    Column("event", pa.string(), "", "failed: at its functional end; suspended: taken out, or outlived the schedule"),
    Column("observed_h", F64, HOURS, "age at the event; after a schedule that ended first that of the last inspection"),
    Column("inspections", I32, "", "inspections before the event"),
    Column("first_pit_h", F64, HOURS, "age at the first pit of any tooth"),
    Column("rated_h", F64, HOURS, "age at 4 % of one flank or 1 % of all flanks of a gear, whether it was seen or not"),
    Column("failure_h", F64, HOURS, "age at the functional end, whether it was seen or not"),
    Column("first_pit_rev", F64, TURNS, "the same in turns of the pinion"),
    Column("rated_rev", F64, TURNS, "the same in turns of the pinion"),
    Column("failure_rev", F64, TURNS, "the same in turns of the pinion"),
    Column("end_gear", pa.string(), "", "gear of the tooth that fails"),
    Column("end_tooth", I32, "", "tooth that fails"),
    Column("functional_share", F64, SHARE, "drawn share of a flank at which it fails, if land is left until then"),
    Column("scale", F64, "", "drawn factor on all times of the law"),
)
INSPECTION_COLUMNS = (
    Column("record_id", pa.int64(), "", "first record of the inspection"),
    SPECIMEN,
    SPLIT,
    Column("inspection", I32, "", "number, from 0; the state_id of its records"),
    Column("age_h", F64, HOURS, "age"),
    Column("age_rev", F64, TURNS, "turns of the pinion so far"),
    Column("damage_time_rev", F64, TURNS, "turns at the reference torque that wear as much, over scale"),
    Column("phase", pa.string(), "", "no pit, pitted, or rated from the rated damage on"),
    Column("life_used", F64, SHARE, "age over the age at the functional end"),
    Column("rul_rated_h", F64, HOURS, "until the rated damage, below 0 after it; null in suspended gearboxes"),
    Column("rul_h", F64, HOURS, "until the functional end; null in suspended gearboxes"),
    Column("rul_at_least_h", F64, HOURS, "until the gearbox was last seen running: what a suspended one is known by"),
)
TEETH_COLUMNS = (
    Column("record_id", pa.int64(), "", "first record of the inspection"),
    SPECIMEN,
    SPLIT,
    Column("inspection", I32, "", "number of the inspection"),
    GEAR,
    TOOTH,
    Column("first_pit_rev", F64, TURNS, "turns of the pinion at the tooth's first pit"),
    Column("pit_count", I32, "", "pits, grown together or not"),
    Column("area_mm2", F64, MM2, "area of the union of their outlines"),
    Column("area_share", F64, SHARE, "the same over that of the flank"),
)
PIT_COLUMNS = (
    SPECIMEN,
    SPLIT,
    GEAR,
    TOOTH,
    Column("pit", I32, "", "number on its tooth, from 0"),
    Column("begun_rev", F64, TURNS, "turns of the pinion at which it began"),
    Column("first_share", F64, SHARE, "share of the flank with which it began"),
    Column(
        "rate_per_rev", F64, "1/rev", "growth of its logarithm per turn of its gear, at reference torque and scale 1"
    ),
    Column("face_mm", F64, MM, "where it began across the face"),
    Column("height_mm", F64, MM, "where it began above the base circle, along the flank"),
)
OUTLOOK_COLUMNS = (
    Column("record_id", pa.int64(), "", "first record of the inspection"),
    SPECIMEN,
    SPLIT,
    Column("inspection", I32, "", "number of the inspection"),
    Column("rul_q10_h", F64, HOURS, "10 % quantile of the remaining life over continuations of the true state"),
    Column("rul_q50_h", F64, HOURS, "its median"),
    Column("rul_q90_h", F64, HOURS, "its 90 % quantile"),
)
OF_INSPECTION = (
    Column("record_id", pa.int64(), "", "first record of the inspection"),
    SPECIMEN,
    SPLIT,
    Column("inspection", I32, "", "number of the inspection"),
)
DEBRIS_COLUMNS = (
    *OF_INSPECTION,
    Column("debris_mg", F64, "mg", "metal that a counter in the oil has counted since age 0, with its errors"),
)
PICTURE_COLUMNS = (
    *OF_INSPECTION,
    GEAR,
    TOOTH,
    Column("png", pa.binary(), "", "grey picture, 0.05 mm per pixel: face across, tip above"),
)
LIFE_TABLES: dict[str, tuple[Column, ...]] = {
    "units": UNIT_COLUMNS,
    "inspections": INSPECTION_COLUMNS,
    "teeth": TEETH_COLUMNS,
    "pits": PIT_COLUMNS,
    "outlook": OUTLOOK_COLUMNS,
    "debris": DEBRIS_COLUMNS,
    "pictures": PICTURE_COLUMNS,
}
"""Tables of `life/<table>.parquet`."""
NULLABLE = {"rul_rated_h", "rul_h"}
"""Columns that are null where a gearbox was suspended: nobody knows them."""
