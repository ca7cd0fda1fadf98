"""One whole recording in each format of recorders: TDMS, universal files as text and binary, HDF5."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np


def recorder_files(folder: Path, channels: Mapping[str, np.ndarray], fs_hz: float) -> list[Path]:
    """Write the channels, each of shape (samples,), with their rate and unit; needs the extra `recordings`."""
    paths = [folder / f"run.{kind}" for kind in ("tdms", "uff", "unv", "h5")]
    _tdms(paths[0], channels, fs_hz)
    _universal(paths[1], channels, fs_hz, binary=0)
    _universal(paths[2], channels, fs_hz, binary=1)
    _hdf5(paths[3], channels, fs_hz)
    return paths


def _tdms(path: Path, channels: Mapping[str, np.ndarray], fs_hz: float) -> None:
    from nptdms import ChannelObject, TdmsWriter

    facts = {"wf_increment": 1.0 / fs_hz, "unit_string": "m/s^2"}
    with TdmsWriter(path) as writer:
        writer.write_segment([ChannelObject("run", name, values, facts) for name, values in channels.items()])


def _universal(path: Path, channels: Mapping[str, np.ndarray], fs_hz: float, *, binary: int) -> None:
    import pyuff

    file = pyuff.UFF(str(path))
    for name, values in channels.items():
        stated = {"type": 58, "binary": binary, "func_type": 1, "id1": name, "abscissa_spacing": 1, "data": values}
        place = {"rsp_node": 1, "rsp_dir": 2, "ref_node": 0, "ref_dir": 0, "x": np.arange(len(values)) / fs_hz}
        kinds = {"abscissa_spec_data_type": 17, "ordinate_spec_data_type": 12, "orddenom_spec_data_type": 0}
        file.write_sets({**stated, **place, **kinds, "ordinate_axis_units_lab": "m/s^2"}, "add")


def _hdf5(path: Path, channels: Mapping[str, np.ndarray], fs_hz: float) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        file.attrs["Sampling_Rate"] = fs_hz
        for name, values in channels.items():
            data = file.create_dataset(f"run/{name}", data=values, compression="gzip")
            data.attrs["unit"] = "m/s^2"
        file["note"] = "text"
