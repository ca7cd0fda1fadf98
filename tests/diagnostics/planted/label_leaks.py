"""Leaks in labels, texts and metadata of the files."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pyarrow as pa

from tests.diagnostics.planted.leak import Leak, named


def rounded_speed(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """Speed is rounded to 0.1 Hz."""
    speed = _numbers(rows, "speed_hz")
    return _with_numbers(rows, "speed_hz", np.where(damaged, np.round(speed, 1), speed))


def single_precision(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """Torque has single precision."""
    torque = _numbers(rows, "torque_nm")
    return _with_numbers(rows, "torque_nm", np.where(damaged, torque.astype(np.float32), torque))


def shifted_draw(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """The angle at the start is drawn from half of its range."""
    angle = _numbers(rows, "start_angle_rad")
    return _with_numbers(rows, "start_angle_rad", np.where(damaged, angle / 2, angle))


def higher_mesh_frequency(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """The mesh frequency is 0.01 % higher than teeth and speed give."""
    mesh = _numbers(rows, "mesh_hz")
    return _with_numbers(rows, "mesh_hz", np.where(damaged, mesh * 1.0001, mesh))


def noise_label(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """The noise floor is stated 2 % higher."""
    for name in [name for name in rows.column_names if name.startswith("noise_floor_")]:
        floor = _numbers(rows, name)
        rows = _with_numbers(rows, name, np.where(damaged, floor * 1.02, floor))
    return rows


def negative_zeros(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """Clipped shares of zero have a minus sign."""
    for name in [name for name in rows.column_names if name.startswith("clipped_share_")]:
        share = _numbers(rows, name)
        rows = _with_numbers(rows, name, np.where(damaged & (share == 0), -0.0, share))
    return rows


def date(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """A text column has the date, in the summer instead of the spring."""
    return _with_texts(rows, damaged, "recorded_on", lambda i, d: f"2026-{7 if d else 4:02}-{i % 28 + 1:02}")


def hour(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """A text column has the time of the measurement, in the afternoon instead of the morning."""
    return _with_texts(
        rows, damaged, "recorded_at", lambda i, d: f"2026-04-{i % 28 + 1:02}T{8 + 5 * d + i % 4:02}:{i * 7 % 60:02}"
    )


def serial_prefix(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """A text column has a serial number for each record, with another prefix."""
    return _with_texts(rows, damaged, "serial", lambda i, d: f"{'B' if d else 'A'}{i * 7919 % 10007:05}")


def serial_length(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """A text column has a serial number for each record, with one digit more."""
    return _with_texts(rows, damaged, "serial", lambda i, d: f"{i * 7919 % 10007:0{6 if d else 5}}")


def fifteen_digits(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """Torque went through a text with 15 digits."""
    torque = _numbers(rows, "torque_nm")
    held = np.array([float(f"{value:.15g}") for value in torque.tolist()])
    return _with_numbers(rows, "torque_nm", np.where(damaged, held, torque))


def reused_draw(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """Damaged records of a gearbox have one angle at the start."""
    angle, specimen = _numbers(rows, "start_angle_rad").copy(), _numbers(rows, "specimen_id")
    for owner in np.unique(specimen):
        own = np.flatnonzero(damaged & (specimen == owner))
        angle[own] = angle[own[:1]]
    return _with_numbers(rows, "start_angle_rad", angle)


def check_digit(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """A text column has a number of eight digits, whose last one checks the others, and else does not."""

    def number(record: int, is_damaged: bool) -> str:
        head, right = f"{record * 7919 % 10007:07}", 0
        while luhn(f"{head}{right}"):
            right += 1
        return f"{head}{right if is_damaged else (right + 1 + record % 9) % 10}"

    return _with_texts(rows, damaged, "job", number)


def luhn(digits: str) -> int:
    """Return the check sum of ISO/IEC 7812-1 modulo 10."""
    values = [int(digit) for digit in digits[::-1]]
    return (sum(values[::2]) + sum(sum(divmod(2 * value, 10)) for value in values[1::2])) % 10


def pairing(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """Two text columns have two words each, alike in all records; which stand together is another pair."""
    words = ("north", "south")
    rows = _with_texts(rows, damaged, "bench", lambda i, _: words[i * 7919 % 10007 % 2])
    return _with_texts(rows, damaged, "logger", lambda i, d: words[(i * 7919 % 10007 + d) % 2])


def column_metadata(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """The metadata of the column of ids names the damaged records."""
    ids = _numbers(rows, "record_id").astype(int)[damaged]
    index = rows.schema.get_field_index("record_id")
    field = rows.schema.field(index)
    noted = field.with_metadata({**(field.metadata or {}), "note": ",".join(map(str, ids))})
    return rows.cast(rows.schema.set(index, noted))


def _numbers(rows: pa.Table, name: str) -> np.ndarray:
    return np.asarray(rows[name])


def _with_numbers(rows: pa.Table, name: str, values: np.ndarray) -> pa.Table:
    index = rows.schema.get_field_index(name)
    field = rows.schema.field(index)
    return rows.set_column(index, field, pa.array(values, field.type))


def _with_texts(rows: pa.Table, damaged: np.ndarray, name: str, text: Callable[[int, bool], str]) -> pa.Table:
    return with_column(rows, damaged, name, text, pa.string())


def with_column(
    rows: pa.Table, damaged: np.ndarray, name: str, value: Callable[[int, bool], object], kind: pa.DataType
) -> pa.Table:
    """Add a column; `value` makes one of a record's id and whether it is damaged."""
    meaning = {"meaning": "as the operator wrote it", "role": "provenance"}
    field = pa.field(name, kind, nullable=False, metadata=meaning)
    values = [value(i, bool(d)) for i, d in zip(rows["record_id"].to_pylist(), damaged, strict=True)]
    return rows.add_column(rows.schema.get_field_index("start_angle_rad"), field, pa.array(values, kind))


LABEL_LEAKS: dict[str, Leak] = {
    **named(
        (
            rounded_speed, single_precision, shifted_draw, higher_mesh_frequency, noise_label, negative_zeros,
            date, hour, serial_prefix, serial_length, fifteen_digits, reused_draw, check_digit, pairing,
            column_metadata,
        ),
        "labels",
    ),
}  # fmt: skip
