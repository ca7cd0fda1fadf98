"""A housing by the modes of a file: read back as it was computed, against a closed form, and what is refused."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from siggen.checks.loading import load_config
from siggen.checks.plausibility import quantities
from siggen.cli.app import app
from siggen.columns.record import SimulatedRecord
from siggen.config import parse_yaml, yaml_text
from siggen.errors import ConfigError
from siggen.gearbox.description import making
from siggen.gearbox.design import SetDesign
from siggen.gearbox.mode_table import seats_of
from siggen.gearbox.plan import planned_record
from siggen.names import PAIR
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from tests.config.minimal import by_name, minimal
from tests.simulated import simulate

INPUTS = seats_of(PAIR)

LID = {"name": "lid", "place": "casing", "axes": ["vertical"], "bits": None, "range_m_s2": 1e6}
SHAPES = {"pinion_bearing/vertical": (0.2, 0.10), "pinion_bearing/horizontal": (0.05, -0.15),
          "gear_bearing/vertical": (0.18, -0.12), "gear_bearing/horizontal": (0.04, 0.2),
          "lid/vertical": (0.25, 0.4)}  # fmt: skip
FREQUENCY_HZ, DAMPING = np.array([410.0, 1730.0]), np.array([0.05, 0.03])
HEAD = "frequency_hz,damping_ratio," + ",".join(f"{p.replace('/', '_')}_per_sqrt_kg" for p in SHAPES)
ROWS = [
    ",".join(map(str, (f, d, *(shape[r] for shape in SHAPES.values()))))
    for r, (f, d) in enumerate(zip(FREQUENCY_HZ, DAMPING, strict=True))
]
PAGE = Path("docs/understand/methods.md")


def written(folder: Path, text: str, **changes: Any) -> Path:
    """Write modes and a configuration that reads them, and return its file."""
    (folder / "modes.csv").write_text(text)
    housing = {"kind": "modal", "modes": "modes.csv"}
    changes = {"dynamics__model": "casing", "duration_s": 0.1, "housing": housing, "sensors": by_name([LID]), **changes}
    source = folder / "set.yaml"
    source.write_text(yaml_text(minimal(**changes)))
    return source


def record(config: SetDesign) -> SimulatedRecord:
    (found,) = simulate(config, [0])
    assert isinstance(found, SimulatedRecord), found
    return found


@pytest.mark.slow
@pytest.mark.parametrize("share", [1.0, 0.2])
def test_a_box_of_plates_read_back_from_its_modes_gives_the_same_record(tmp_path: Path, share: float) -> None:
    """All of it: modes that move with the gears, residual flexibility, base, second stage, other drive, a foot."""
    file, foot = tmp_path / "modes.csv", f"housing.loose_foot_share={share}"
    result = CliRunner().invoke(app, ["inspect", "housing", "quickstart", "--out", str(file), "--set", foot])
    assert result.exit_code == 0, result.output
    # modes tell nothing of the walls through which the oil cools
    short, oil = "duration_s=0.1", "dynamics.friction.oil_temperature_c=50"
    computed = load_config("quickstart", [short, oil, foot])
    given = load_config("quickstart", [short, oil, "housing.kind=modal", f"housing.modes={file}"])
    file.unlink()
    first, second = record(computed).channels, record(load_config(parse_yaml(yaml_text(given.canonical())))).channels
    for name, values in first.items():
        # what is stored has whole steps of the converter: a last bit may tip one of them over
        np.testing.assert_allclose(second[name], values, atol=1e-9 * values.std())


def test_a_sensor_sees_two_modes_as_their_closed_form_says(tmp_path: Path) -> None:
    config = load_config(written(tmp_path, "\n".join([HEAD, *ROWS])))
    found, specimen = record(config).channels["lid_vertical"], config.gearbox(0)
    response, _ = record_response(specimen, specimen_state(specimen, 0), planned_record(config, 0))
    length = 2**16  # one transform, in which nothing wraps round
    omega, own = 2.0 * np.pi * np.arange(length // 2 + 1) * config.fs_hz / length, 2.0 * np.pi * FREQUENCY_HZ
    total = np.zeros(omega.size, dtype=complex)
    for name in INPUTS:
        past, force = response.history.bearing_force_n[name], response.bearing_force_n[name]
        spectrum = np.fft.rfft(np.concatenate([past, force]) - past.mean(), length)
        for r in range(2):
            share = -(omega**2) / (own[r] ** 2 - omega**2 + 2j * DAMPING[r] * own[r] * omega)
            total += SHAPES["lid/vertical"][r] * SHAPES[name][r] * share * spectrum
    behind = past.size + force.size
    expected = np.fft.irfft(total, length)[behind - config.samples : behind]
    # filters end where 1e-3 of the slowest mode is left; here forces break off with the record
    assert np.abs(found - expected)[:-512].max() < 1e-2 * expected.std()


def test_modes_are_part_of_the_set_and_the_folder_is_not(tmp_path: Path) -> None:
    text = "\n".join([HEAD, *ROWS])
    config = load_config(written(tmp_path, text))
    other = tmp_path / "elsewhere"
    other.mkdir()
    assert load_config(written(other, "# measured in May\n" + text)).identity == config.identity
    assert load_config(written(other, text.replace("1730", "1731"))).identity != config.identity
    (tmp_path / "modes.csv").unlink()
    assert load_config(parse_yaml(yaml_text(config.canonical()))).identity == config.identity


def test_the_example_of_the_page_is_read(tmp_path: Path) -> None:
    (text,) = re.findall(r"```text\n(# a box.*?)```", PAGE.read_text(), re.DOTALL)
    config = load_config(written(tmp_path, text))
    assert record(config).channels["lid_vertical"].std() > 0.0
    assert not [one for one in quantities(config.possible) if one.path == "housing.modes" and one.implausible]


BAD = {
    "line 3: damping_ratio -0.03": ([HEAD, ROWS[0], ROWS[1].replace("0.03", "-0.03")], "above 0 and below 0.5"),
    "line 3: frequency_hz 410": ([HEAD, ROWS[1], ROWS[0]], "at least 1730"),
    "line 2: frequency_hz 0": ([HEAD, "0" + ROWS[0].removeprefix("410.0"), ROWS[1]], "stands on its feet"),
    "line 3: pinion_bearing_vertical_per_sqrt_kg 'nan'": ([HEAD, ROWS[0], ROWS[1].replace("0.1,", "nan,")], "finite"),
    "line 3: 6 numbers": ([HEAD, ROWS[0], ROWS[1].rpartition(",")[0]], "7, one per column"),
    "line 1: the column 'frequency'": ([HEAD.replace("frequency_hz", "frequency"), *ROWS], "mean 'frequency_hz'"),
    "no column gear_bearing_vertical_per_sqrt_kg": (
        [HEAD.replace("gear_bearing_v", "gaer_bearing_v"), *ROWS],
        "did you mean 'gaer_bearing_vertical_per_sqrt_kg'",
    ),
    "no column lid_vertical_per_sqrt_kg": (
        [HEAD.replace("lid_vertical", "lid_axial"), *ROWS],
        "for the sensor lid",
    ),
    "no mode": ([HEAD], "at least one"),
}


@pytest.mark.parametrize("received", BAD)
def test_what_is_wrong_with_a_file_is_said_with_its_line(tmp_path: Path, received: str) -> None:
    lines, allowed = BAD[received]
    with pytest.raises(ConfigError) as refused:
        load_config(written(tmp_path, "\n".join(lines)))
    (problem,) = refused.value.problems
    assert (problem.path, problem.received) == ("housing.modes", received)
    assert allowed in problem.allowed


def test_shapes_of_another_scale_are_implausible(tmp_path: Path) -> None:
    """As of a model in tonnes: shapes in 1/sqrt(t) are 32 times as large."""
    rows = [",".join([*row.split(",")[:2], *(str(31.6 * float(x)) for x in row.split(",")[2:])]) for row in ROWS]
    config = load_config(written(tmp_path, "\n".join([HEAD, *rows])))
    assert [one for one in quantities(config.possible) if one.path == "housing.modes" and one.implausible]


def test_a_base_needs_participation_factors(tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as refused:
        load_config(written(tmp_path, "\n".join([HEAD, *ROWS]), background={"base": {}}))
    assert {one.received for one in refused.value.problems} == {
        f"no column base_{name}" for name in ("horizontal_sqrt_kg", "vertical_sqrt_kg", "rocking_sqrt_kg_m")
    }


def test_the_card_of_a_set_says_where_its_housing_is_from(tmp_path: Path) -> None:
    config = load_config(written(tmp_path, "\n".join([HEAD, *ROWS])))
    assert "through a housing of which 2 modes were given, the same for every specimen" in " ".join(
        making(config).split()
    )
