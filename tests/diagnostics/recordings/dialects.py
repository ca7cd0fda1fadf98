"""Small recordings in the dialects of loggers, each with the right reading or the words of the refusal; made, not kept.

Two channels of 1600 samples at 6400 Hz. A reading is: channels in m/s2, their rate, the facts that a user has to say.
"""

from __future__ import annotations

import datetime
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.recordings.taken import RecordingFacts

FS_HZ, SAMPLES = 6400.0, 1600
G = 9.80665
TIME_S = np.arange(SAMPLES) / FS_HZ
_rng = np.random.default_rng(5)
LEFT, RIGHT = (
    np.round(3.0 * np.sin(2 * np.pi * hz * TIME_S + k) + 0.5 * _rng.standard_normal(SAMPLES), 5)
    for k, hz in enumerate((640.0, 410.0))
)
JITTER = 0.2 * _rng.uniform(-1.0, 1.0, SAMPLES) / FS_HZ


@dataclass(frozen=True)
class Dialect:
    """A file: its name, what writes it, what its user says, and factor and number of channels, or a refusal."""

    name: str
    write: Callable[[Path], object]
    factor: float = 1.0
    refused: str = ""
    facts: dict[str, Any] = field(default_factory=dict)
    channels: int = 2
    says: str = ""

    def said(self) -> RecordingFacts:
        """Return what the user says."""
        return RecordingFacts(**self.facts)


def _lines(
    head: Sequence[str], separator: str = ",", decimal: str = ".", *, time: str = "{:.7f}", form: str = "{:.5f}",
    times: Sequence[Any] | np.ndarray | None = TIME_S, foot: Sequence[str] = (), more: Sequence[Any] | None = None,
) -> list[str]:  # fmt: skip
    columns = [] if times is None else [[t if isinstance(t, str) else time.format(t) for t in times]]
    columns += [[form.format(value) for value in values] for values in (LEFT, RIGHT)]
    kept = times is None or not isinstance(times[0], str)
    columns = [[cell.replace(".", decimal) if kept or k else cell for cell in c] for k, c in enumerate(columns)]
    if more is not None:
        columns.append([str(cell) for cell in more])
    return [*head, *(separator.join(cells) for cells in zip(*columns, strict=True)), *foot]


def text(
    name: str, lines: Sequence[str], factor: float = 1.0, refused: str = "", *, encoding: str = "utf-8",
    end: str = "\n", **facts: Any,
) -> Dialect:  # fmt: skip
    """Return a dialect of a text file."""
    says = facts.pop("says", "")

    def write(path: Path) -> None:
        path.write_text(end.join(lines) + end, encoding=encoding, newline="")

    return Dialect(name, write, factor, refused, facts, says=says)


def _stamps(form: Callable[[datetime.datetime], str], start: datetime.datetime) -> list[str]:
    return [form(start + datetime.timedelta(seconds=float(t))) for t in TIME_S]


def texts() -> list[Dialect]:
    """Return the dialects of text files."""
    names, unit = "time,left,right", "time,left [m/s2],right [m/s2]"
    noon = datetime.datetime(2024, 5, 6, 10, 3, 0)
    night = datetime.datetime(2024, 5, 6, 23, 59, 59, 900_000)
    iso = _stamps(lambda at: at.isoformat(timespec="microseconds") + "Z", noon)
    clock = _stamps(lambda at: at.strftime("%H:%M:%S.%f"), night)
    german = _stamps(lambda at: at.strftime("%d.%m.%Y %H:%M:%S,%f"), noon)
    half = _stamps(lambda at: at.strftime("%m/%d/%Y %I:%M:%S.%f PM"), noon)
    lvm = [
        *("LabVIEW Measurement\t", "Writer_Version\t2", "Separator\tTab", "Decimal_Separator\t,", "Date\t2024/05/06"),
        *("***End_of_Header***\t", "", "Channels\t2\t", f"Samples\t{SAMPLES}\t{SAMPLES}", "Y_Unit_Label\tg\tg"),
        *("X0\t0\t0", "Delta_X\t0,00015625\t0,00015625", "***End_of_Header***\t\t", "X_Value\tleft\tright\tComment"),
    ]
    gap = (TIME_S < 0.1) | (TIME_S > 0.12)
    lost = [line for line, kept in zip(_lines([]), gap, strict=True) if kept]
    back = TIME_S - np.where(TIME_S > 0.15, 0.1, 0.0)
    unix = 1_714_989_780.0
    bad = _lines([names])
    bad[700] = bad[700].replace(bad[700].split(",")[1], "overload")
    short = _lines([names])
    short[700] = short[700].rpartition(",")[0]
    integers = [f"{int(1000 * a) % 977},{int(1000 * b) % 977}" for a, b in zip(LEFT, RIGHT, strict=True)]
    cells = [(f"{a:.5f}".replace(".", ","), f"{b:.5f}".replace(".", ",")) for a, b in zip(LEFT, RIGHT, strict=True)]
    quoted = [f'"{a}","{b}"' for a, b in cells]
    return [
        text("plain.csv", _lines([unit])),
        text("no_unit.csv", _lines([names]), refused=r"no unit of left is stated.*unit: g"),
        text("no_unit_said.csv", _lines([names]), G, unit="g"),
        text("g.csv", _lines(["time,left [g],right [g]"]), G),
        text("mg.csv", _lines(["time_s,left_mg,right_mg"]), 1e-3 * G),
        text("row.csv", _lines([names, "s,g,g"]), G),
        text("row_brackets.csv", _lines([names, "[s],[m/s²],[m/s²]"])),
        text("row_ms.csv", _lines([names, "ms,g,g"], times=1e3 * TIME_S), G),
        text("mixed_units.csv", _lines(["time,left [mm/s],right [mm/s]"]), refused="no acceleration .velocity"),
        text("volts.csv", _lines(["left (V),right (V)"], times=None), refused="sensitivity"),
        text("volts_said.csv", _lines(["time,left (V),right (V)"]), 10.0 * G, sensitivity_mv_per_g=100.0),
        text("two_units.csv", _lines(["time,left [g],right [g]", "s,m/s2,m/s2"]), refused="its name states the unit g"),
        text("semicolon.csv", _lines(["Zeit [s];links [m/s²];rechts [m/s²]"], ";", ","), encoding="utf-8-sig"),
        text("sep.csv", ["sep=;", *_lines(["t [s];a [g];b [g]"], ";", ",")], G, end="\r\n"),
        text("tab.txt", _lines(["t\tleft [g]\tright [g]"], "\t"), G),
        text("tab_comma.txt", _lines(["t\tleft [g]\tright [g]"], "\t", ","), G, encoding="utf-16"),
        text("latin.csv", _lines(["Zeit [s];Gehäuse [m/s²];Lager [m/s²]"], ";", ","), encoding="cp1252"),
        text("blanks.txt", _lines(["# time left right", "# s g g"], "   ", form="{:12.5f}"), G),
        text("blank_names.txt", _lines(["time left_g right_g"], " "), refused="no unit of left_g is stated"),
        text("stroke.dat", _lines(["time|left [g]|right [g]"], "|"), G),
        text("fortran.txt", [line.replace("E", "D") for line in _lines([], " ", time="{:15.8E}", form="{:15.6E}")],
             unit="m/s2"),
        text("plus.csv", _lines([unit], form="{:+.5f}", time="{:+.7f}")),
        text("quoted.csv", ['"left [g]","right [g]"', *quoted], G, fs_hz=FS_HZ),
        text("comma_at_end.csv", [line + "," for line in _lines([unit])]),
        text("foot.csv", _lines([unit], foot=["", "End of recording", "Max,3.1"]), says="3 lines behind the data"),
        text("head.csv", _lines(["Recorder 12, serial 0", "Start 10:03:00", "Rate: 6400 Hz", "---",
                                 "left [g],right [g]"], times=None), refused=r"--fs 6400"),
        text("no_rate.csv", _lines(["left [g],right [g]"], times=None), refused="sampling rate.*--fs"),
        text("said_rate.csv", _lines(["left [g],right [g]"], times=None), G, fs_hz=FS_HZ),
        text("counter.csv", _lines(["sample,left [g],right [g]"], times=range(SAMPLES), time="{}"), G, fs_hz=FS_HZ),
        text("index.csv", _lines([",left [g],right [g]"], times=np.arange(SAMPLES), time="{:.0f}"), G, fs_hz=FS_HZ),
        text("milliseconds.csv", _lines(["time,left [g],right [g]"], times=1e3 * TIME_S), refused=r"6\.4 Hz.*--fs"),
        text("milliseconds_said.csv", _lines(["time,left [g],right [g]"], times=1e3 * TIME_S), G, fs_hz=FS_HZ),
        text("iso.csv", _lines(["when,left [g],right [g]"], times=iso), G),
        text("midnight.csv", _lines(["time,left [g],right [g]"], times=clock), G),
        text("german.csv", _lines(["Zeit;a [g];b [g]"], ";", ",", times=german), G),
        text("half_days.csv", _lines(["time,left [g],right [g]"], times=half), G),
        text("unix.csv", _lines(["timestamp,left [g],right [g]"], times=unix + TIME_S), G),
        text("unix_ms.csv", _lines(["timestamp,left [g],right [g]"], times=1e3 * (unix + TIME_S), time="{:.5f}"), G),
        text("unix_us.csv", _lines(["timestamp,left [g],right [g]"], times=1e6 * (unix + TIME_S), time="{:.2f}"), G),
        text("rounded.csv", _lines(["time,left [g],right [g]"], time="{:.5f}"), G),
        text("coarse.csv", _lines(["time,left [g],right [g]"], time="{:.3f}"), refused="repeats its coarse times"),
        text("jitter.csv", _lines(["time,left [g],right [g]"], times=TIME_S + JITTER), refused="uneven.*resample_hz"),
        text("gap.csv", ["time,left [g],right [g]", *lost], refused="has a gap.*longest whole piece"),
        text("back.csv", _lines(["time,left [g],right [g]"], times=back), refused="steps back"),
        text("rpm.csv", _lines(["time,left [g],right [g],rpm"], more=[f"{1440 + k % 7}" for k in range(SAMPLES)]), G),
        text("label.csv", _lines(["time,left [g],right [g],state"], more=["healthy"] * SAMPLES), G),
        text("doubled.csv", _lines(["time,left,left"]), refused=r"line 1: 2 columns are called left \(columns 2, 3\)"),
        text("text_inside.csv", bad, refused=r"line 701, column left: 'overload' is no number; delete all lines"),
        text("short_line.csv", short, refused=r"line 701 has 2 cells, those around it 3"),
        text("names_twice.csv", _lines(["time,left,right", "here,there,where"]), refused="could both be names"),
        text("two_times.csv", _lines(["time,left [g],right [g],zeit"], more=[f"{2 * t:.6f}" for t in TIME_S]),
             refused="two times"),
        text("commas.csv", integers, refused="separator or decimal mark"),
        text("header.lvm", [line + "\t" * (k >= 14) for k, line in enumerate(_lines(lvm, "\t", ","))], G),
        text("lvm_as.txt", [line + "\t" * (k >= 14) for k, line in enumerate(_lines(lvm, "\t", ","))], G),
        text("thousands.csv", ["left [g];right [g]", "1.234,5;2", *["3,5;4"] * 5], refused="is no number"),
    ]  # fmt: skip


def arrays() -> list[Dialect]:
    """Return the dialects of files of arrays and recorders."""
    return [
        Dialect("flat.mat", _mat({"left": LEFT[:, None], "right": RIGHT[:-1, None], "Fs": FS_HZ}),
                facts={"unit": "m/s2"}, says="cut to the shortest by 1"),
        Dialect("lengths.mat", _mat({"left": LEFT, "right": RIGHT[:-100], "fs": FS_HZ}), facts={"unit": "m/s2"},
                refused="differ in their number of samples"),
        Dialect("struct.mat", _mat({"run": {"acc": {"left": LEFT, "right": RIGHT}, "sr": FS_HZ, "unit": "g"}}), G),
        Dialect("cells.mat", _mat({"run": np.array([LEFT, RIGHT, "note"], dtype=object), "dt": 1.0 / FS_HZ}),
                facts={"unit": "g"}, factor=G),
        Dialect("v73.mat", _mat73, G, facts={"unit": "g"}),
        Dialect("attributes.h5", _hdf5, G),
        Dialect("shifted.tdms", _tdms, G, says="begins 0.015625 s later"),
        Dialect("ascii.uff", _uff(0), G),
        Dialect("binary.unv", _uff(1), G),
        Dialect("integer.wav", _wav, refused="full_scale: 50", facts={"unit": "g"}),
        Dialect("integer_said.wav", _wav, G, facts={"unit": "g", "full_scale": 8.0}),
        Dialect("audio.parquet", _audio, G, facts={"unit": "g"}, channels=1),
        Dialect("columns.parquet", _columns, G),
        Dialect("named.npz", lambda path: np.savez(path, left_mg=LEFT, right_mg=RIGHT, fs=FS_HZ), 1e-3 * G),
        Dialect("rows.npy", lambda path: np.save(path, np.stack([TIME_S, LEFT, RIGHT], 1)), G, facts={"unit": "g"}),
        Dialect("many.npz", lambda path: np.savez(path, fs=FS_HZ, **{f"c{k}": LEFT for k in range(40)}),
                facts={"unit": "g"}, refused="40 columns that could be vibration.*channels"),
        Dialect("recorder.mf4", _mdf, G),
    ]  # fmt: skip


def _mat(held: dict[str, Any]) -> Callable[[Path], object]:
    from scipy.io import savemat

    return lambda path: savemat(path, held)


def _mat73(path: Path) -> None:
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        for name, value in (("left", LEFT), ("right", RIGHT), ("fs", np.array([FS_HZ]))):
            file.create_dataset(name, data=value[None, :]).attrs["MATLAB_class"] = np.bytes_("double")
    content = path.read_bytes()
    path.write_bytes(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM" + content[128:])


def _hdf5(path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        for name, value in (("left", LEFT), ("right", RIGHT)):
            file.create_dataset(f"run/{name}", data=value).attrs["unit"] = "g"
        file["run"].attrs["sampling_rate"] = FS_HZ


def _tdms(path: Path) -> None:
    from nptdms import ChannelObject, TdmsWriter

    facts = {"wf_increment": 1.0 / FS_HZ, "unit_string": "g"}
    with TdmsWriter(path) as writer:
        writer.write_segment(
            [
                ChannelObject("run", "left", LEFT, {**facts, "wf_start_offset": 0.0}),
                ChannelObject("run", "right", RIGHT[100:], {**facts, "wf_start_offset": 100 / FS_HZ}),
            ]
        )


def _uff(binary: int) -> Callable[[Path], None]:
    def write(path: Path) -> None:
        import pyuff

        file = pyuff.UFF(str(path))
        for name, values in (("left", LEFT), ("right", RIGHT)):
            stated = {"type": 58, "binary": binary, "func_type": 1, "id1": name, "abscissa_spacing": 1, "data": values}
            place = {"rsp_node": 1, "rsp_dir": 2, "ref_node": 0, "ref_dir": 0, "x": TIME_S}
            kinds = {"abscissa_spec_data_type": 17, "ordinate_spec_data_type": 12, "orddenom_spec_data_type": 0}
            file.write_sets({**stated, **place, **kinds, "ordinate_axis_units_lab": "(g)"}, "add")

    return write


def _wav(path: Path) -> None:
    from scipy.io import wavfile

    wavfile.write(path, int(FS_HZ), np.round(np.stack([LEFT, RIGHT], axis=1) / 8.0 * 32768).astype(np.int16))


def _audio(path: Path) -> None:
    import pyarrow as pa
    from pyarrow import parquet

    cell = pa.array([{"array": LEFT.tolist(), "sampling_rate": int(FS_HZ)}])
    parquet.write_table(pa.table({"audio": cell, "label": [1]}), path)


def _columns(path: Path) -> None:
    import pyarrow as pa
    from pyarrow import parquet

    start = datetime.datetime(2024, 5, 6, 10, 3)
    stamps = [start + datetime.timedelta(microseconds=round(1e6 * t)) for t in TIME_S]
    parquet.write_table(pa.table({"stamp": pa.array(stamps), "left [g]": LEFT, "right [g]": RIGHT}), path)


def _mdf(path: Path) -> None:
    from asammdf import MDF, Signal

    with MDF(version="4.10") as file:
        file.append([Signal(LEFT, TIME_S, name="left", unit="g"), Signal(RIGHT, TIME_S, name="right", unit="g")])
        file.append([Signal(np.arange(10.0), np.arange(10.0), name="oil", unit="degC")])
        file.save(path, overwrite=True)
