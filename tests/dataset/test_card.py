"""The card: front matter that Hugging Face reads, and no claim that the set does not keep."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from siggen.checks.loading import load_config
from siggen.config import Manufacture
from siggen.dataset.card import _limits
from siggen.gearbox.description import background_text, damage_text, drive_text, making
from siggen.gearbox.design import SetDesign
from siggen.keys.distributions import Choice
from tests.dataset.fake_set import fake_config, simulate_with_failures, write_fake_set


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sets") / "fake"
    write_fake_set(path)
    return path


def front_matter(folder: Path) -> dict:
    return yaml.safe_load((folder / "README.md").read_text().split("---\n")[1])


def test_the_front_matter_names_every_parquet_file_exactly_once(folder: Path) -> None:
    facts = front_matter(folder)
    views = {view["config_name"]: view["data_files"] for view in facts["configs"]}
    assert list(views) == ["signals", "labels", "damage"]
    assert [view["config_name"] for view in facts["configs"] if view.get("default")] == ["signals"]
    matched = [path for files in views.values() for file in files for path in folder.glob(file["path"])]
    assert sorted(matched) == sorted(folder.rglob("*.parquet"))
    assert [file["split"] for file in views["signals"]] == ["train", "validation", "test"]
    assert all(path.name.startswith(file["split"]) for file in views["signals"] for path in folder.glob(file["path"]))
    assert [file["split"] for view in ("labels", "damage") for file in views[view]] == ["records"] * 2
    assert facts["size_categories"] == ["n<1K"]
    assert "license" not in facts  # which licence, only the authors can say
    assert facts["pretty_name"]


def test_splits_without_gearboxes_are_not_promised(tmp_path: Path) -> None:
    write_fake_set(tmp_path, fake_config(specimens=1, splits={"train": 20, "validation": 0, "test": 0}))
    files = [file["split"] for view in front_matter(tmp_path)["configs"] for file in view["data_files"]]
    assert files == ["train", "records", "records"]


def test_every_column_is_explained_with_its_unit(folder: Path) -> None:
    text = (folder / "README.md").read_text()
    assert "| `accel_bearing_vertical_m_s2` | float[512] | m/s^2 | acceleration at pinion_bearing, vertical" in text
    assert "| `torque_nm` | double | N m |" in text
    assert "| `depth_mm` | double | mm |" in text


def test_the_card_says_that_error_free_gears_separate_trivially(folder: Path) -> None:
    text = (folder / "README.md").read_text()
    assert "no manufacturing errors" in text
    assert "separate trivially" in text


def test_the_card_says_which_class_the_gears_were_made_to_and_who_shares_them() -> None:
    classes = Choice(values=(5.0, 6.0, 7.0))
    config = fake_config(specimens=1).with_sections(manufacture=Manufacture(accuracy_class=classes))
    text = _limits(config)
    assert "no manufacturing errors" not in text
    assert "class 5, 6 or 7 of ISO 1328-1\n  (share used: [0.3, 0.5])" in text
    assert "a difference between\n  its states is the damage" in text


def test_failed_records_are_on_the_card(tmp_path: Path) -> None:
    write_fake_set(tmp_path, simulation=simulate_with_failures)
    text = (tmp_path / "README.md").read_text()
    assert "3 planned records could not be simulated" in text
    assert "| 8 | diverged | motion left the backlash |" in text


def test_the_loading_example_of_the_card_runs(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """pyarrow and siggen are here; the other readers are tested where they are installed."""
    text = (folder / "README.md").read_text().split("```python\n")[1].split("```")[0]
    monkeypatch.chdir(folder)
    scope: dict = {}
    exec("import numpy as np\n" + text[text.index("import pyarrow") : text.index("import duckdb")], scope)
    exec(text[text.index("import siggen") :], scope)
    assert scope["signals"].shape[1] == 512
    assert scope["record"]["record_id"] == 0
    assert scope["values"].shape == (18, 512)


def shipped(name: str, *overrides: str) -> SetDesign:
    return load_config(name, overrides)


def test_the_card_says_how_damage_acts_in_this_very_set() -> None:
    stiffness, geometry, both = (
        damage_text(shipped(name).config) for name in ("tests/configs/linear_pits.yaml", "quickstart", "paper_b")
    )
    assert "remove material from the tooth's sections" in stiffness
    assert "sinks" not in stiffness
    assert "the mating flank sinks" in geometry
    assert "sections keep their strength" in geometry
    assert "remove material" not in geometry
    assert "the mating flank sinks" in both
    assert "weakens them" in both
    assert "every state is healthy" in damage_text(shipped("quickstart", "states={healthy: {}}").config)


def test_the_card_says_what_rubs_what_varies_and_what_makes_noise() -> None:
    plain, rich = (making(shipped(name)) for name in ("tests/configs/linear_pits.yaml", "quickstart"))
    longest = max(map(len, [*plain.splitlines(), *rich.splitlines()]))
    plain, rich = (" ".join(text.split()) for text in (plain, rich))
    assert "no friction between the flanks" in plain
    assert "Speed and torque are constant" in plain
    assert "noise is added" not in plain
    assert "film of ISO VG 220" in rich
    assert "Within a record speed and torque vary" in rich
    assert "through a box of plates on bolts" in rich
    assert "box of plates" not in plain
    torque = shipped("tests/configs/linear_pits.yaml", "variation.torque.random_rms=0.01")
    assert drive_text(torque.config) == "Within a record torque varies (`variation`); the speed is constant."
    assert "Shafts bend" not in plain
    assert "healthy machine adds" not in plain
    across = "The contact is solved across the face and depends on the load (`dynamics.mesh.law: pairs`). Shafts bend"
    assert across in rich
    one = background_text(shipped("quickstart", "background={machines: {}}").config)
    assert one == "A healthy machine adds noise of motor and load (`background`); the levels belong to the gearbox. "
    assert "rubbing of rough flanks, " in rich
    assert longest <= 118


def test_the_card_states_the_error_that_the_steps_are_chosen_for() -> None:
    stated = making(fake_config(dynamics={"integration_tolerance": 2e-4}))
    assert "relative rms error of 0.0002" in " ".join(stated.split())
    linear = {"mesh": {"law": "linear"}}
    assert "no error is stated" in " ".join(making(fake_config(dynamics=linear)).split())
