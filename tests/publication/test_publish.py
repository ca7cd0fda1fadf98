"""Published folders: what the authors have to say, what the card says, and that other readers read the same values."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml
from typer.testing import CliRunner

import siggen
from siggen.checks.loading import load_config
from siggen.cli.app import app
from siggen.errors import ConfigError, UsageError
from siggen.gearbox.description import assumed_numbers_section, class_words, physics_section
from siggen.publication.publication_facts import TEMPLATE, read_publication_facts
from siggen.publication.publish import publish
from siggen.publication.spdx_licence import _identifiers
from siggen.sets.verification import verify
from tests.config.mill import mill
from tests.config.planets import planets
from tests.config.staged import staged
from tests.publication.conftest import facts_file


def test_without_the_authors_nothing_is_published(kept: Path, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"(?s)license is unset.*license: unset .*authors:"):
        publish(kept, tmp_path / "set", None)
    (tmp_path / "publication.yaml").write_text(TEMPLATE)
    with pytest.raises(ConfigError) as caught:
        publish(kept, tmp_path / "set", tmp_path / "publication.yaml")
    unset = {problem.path for problem in caught.value.problems if problem.received == "unset"}
    assert unset == {"license", "title", "published", "publisher", "url", "citation", "authors.0.name"}
    assert not (tmp_path / "set").exists()


@pytest.mark.parametrize("where", ["sub", "data/sub", ".", "..", "../set/../set/sub", "../link/sub"])
def test_a_target_in_the_set_or_around_it_is_refused(kept: Path, tmp_path: Path, where: str) -> None:
    folder = Path(shutil.copytree(kept, tmp_path / "set"))
    (tmp_path / "link").symlink_to(folder)
    before = sorted(folder.rglob("*"))
    given = ["publish", str(folder), "--to", str(folder / where), "--facts", str(facts_file(tmp_path))]
    with pytest.raises(UsageError, match="allowed: a folder beside the set"):
        CliRunner().invoke(app, given, catch_exceptions=False)
    assert sorted(folder.rglob("*")) == before


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"license": "unset"}, "license"),
        ({"license": "free for all"}, "license"),
        ({"license": "LicenseRef-"}, "license"),
        ({"license": "cc-by-4.0 OR mit"}, "license"),
        ({"published": "30.11.2026"}, "published"),
        ({"published": "2026-02-30"}, "published"),
        ({"version": "1"}, "version"),
        ({"url": "example.org"}, "url"),
        ({"doi": "doi:10.5281/zenodo.1"}, "doi"),
        ({"authors": []}, "authors"),
        ({"authors": [{"name": "A, B", "orcid": "1"}]}, "authors.0.orcid"),
        ({"licence": "cc0-1.0"}, "licence"),
        ({"with_recordings": "yes"}, "with_recordings"),
    ],
)
def test_what_the_authors_say_has_to_have_its_form(tmp_path: Path, changes: dict[str, Any], path: str) -> None:
    with pytest.raises(ConfigError) as caught:
        read_publication_facts(facts_file(tmp_path, **changes))
    assert [problem.path for problem in caught.value.problems] == [path]


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("cc-by-4", "CC-BY-4.0"),
        ("CC BY 4.0", "CC-BY-4.0"),
        ("ODC-By", "ODC-By-1.0"),
        ("the MIT License", "MIT"),
        ("GPL-2.0", "GPL-2.0-only"),  # deprecated: does not say whether later versions hold as well
    ],
)
def test_a_licence_that_spdx_does_not_know_is_refused_with_the_nearest(tmp_path: Path, said: str, meant: str) -> None:
    with pytest.raises(ConfigError, match=rf"license.*'{said}'.*Did you mean {meant}\?"):
        read_publication_facts(facts_file(tmp_path, license=said))
    assert read_publication_facts(facts_file(tmp_path, license=meant)).license == meant


def test_own_licences_have_the_form_that_spdx_gives_them_and_nothing_alike_is_not_guessed(tmp_path: Path) -> None:
    assert read_publication_facts(facts_file(tmp_path, license="LicenseRef-institute.2")).license.endswith(
        "institute.2"
    )
    with pytest.raises(ConfigError) as caught:
        read_publication_facts(facts_file(tmp_path, license="????"))
    assert "Did you mean" not in str(caught.value)


def test_the_list_of_licences_is_that_of_an_independent_library() -> None:
    from packaging.licenses import canonicalize_license_expression

    names = _identifiers()
    assert {"CC-BY-4.0", "CC0-1.0", "ODC-By-1.0", "BSD-3-Clause"} <= set(names.values())
    assert all(canonicalize_license_expression(lower) == name for lower, name in names.items())


def test_what_publish_returns_is_one_short_line(kept: Path, tmp_path: Path) -> None:
    shown = repr(publish(kept, tmp_path / "set", facts_file(tmp_path)))
    assert re.fullmatch(r"Publication\(\d+ files made, \d+ files of [\d.]+ MB copied, audit None\)", shown)


def test_a_published_folder_is_a_set_that_opens_and_verifies(kept: Path, published: Path) -> None:
    found = verify(published, 0)
    assert found.mismatches == ()
    names = set(siggen.open(published).manifest["files"])
    made = {"croissant.json", "README.md"}
    assert names > {*made, "previews/healthy.png", "previews/severe.png"}
    for name in ("data/train-00000.parquet", "config.yaml", "labels.parquet"):
        assert (published / name).read_bytes() == (kept / name).read_bytes()
    (published / "croissant.json").write_bytes((published / "croissant.json").read_bytes() + b" ")
    assert [mismatch.what for mismatch in verify(published, 0).mismatches] == ["croissant.json"]
    (published / "croissant.json").write_bytes((published / "croissant.json").read_bytes()[:-1])


def test_the_card_says_what_is_on_what_was_assumed_and_who_says_so(published: Path) -> None:
    card = (published / "README.md").read_text()
    for line in (
        "| friction of the flanks | on |",
        "| contact across the face, damage as geometry | on |",
        "| housing that gives way | on |",
        "| background of a healthy machine | off |",
        "| `gears.module_mm` | 3 | configuration | normal module |",
        "| `dynamics.friction.pit_roughness_um` | 2 | default |",
        "* Author, An, An institute (https://orcid.org/0000-0002-1825-0097)",
        "Nobody has looked for what makes this set trivially separable",
    ):
        assert line in card
    assert "under the licence `cc-by-4.0`" in card


def test_the_card_of_a_machine_says_what_its_file_says() -> None:
    config = load_config(mill())
    text = assumed_numbers_section(config)
    rows = {cells[1].strip(" `"): cells[2].strip() for line in text.splitlines() if len(cells := line.split("|")) > 2}
    assert "pinion" not in text + physics_section(config)
    assert not [key for key in rows if key.startswith(("gears", "stages", "planetary", "dynamics.gear"))]
    expected = {"machine.gears.eva.teeth": "17", "sensors.bearing.place": "input_bearing"}
    assert {key: rows[key] for key in expected} == expected
    assert "gear eva" in rows["states.severe.damage"]


def test_the_card_quotes_the_strongest_detector_of_the_audit_of_this_set_alone(kept: Path, tmp_path: Path) -> None:
    best = {
        "slight": {"indicator": "rms__x", "tried": 40, "auc_chosen_on_other_gearboxes": 0.71},
        "severe": {"indicator": "fm4__x", "tried": 40, "auc_chosen_on_other_gearboxes": 0.98},
    }
    identity = siggen.open(kept).manifest["identity"]
    verdict = "1 leak was found."  # as the audit writes it: the summary opens with it
    audit = {"identity": identity, "verdict": verdict, "summary": [verdict, "More."], "best_single_indicator": best}
    (tmp_path / "audit.json").write_text(json.dumps(audit))
    publish(kept, tmp_path / "set", facts_file(tmp_path), tmp_path)
    card = (tmp_path / "set/README.md").read_text()
    assert "## Audit\n\nVerdict: 1 leak was found. More.\n\n" in card
    assert "| severe | `fm4__x` | 0.980 | 40 |\n| slight | `rms__x` | 0.710 | 40 |" in card
    entry = {"state": "severe", "chosen": "a band", "tried": 410, "auc": {"value": 0.99}}
    (tmp_path / "audit.json").write_text(json.dumps({**audit, "strongest": {"alone": {"states": [entry]}}}))
    publish(kept, tmp_path / "again", facts_file(tmp_path), tmp_path)
    assert "| alone | severe | a band | 0.990 | 410 |" in (tmp_path / "again/README.md").read_text()
    (tmp_path / "audit.json").write_text(json.dumps({**audit, "too_few_gearboxes": True}))
    publish(kept, tmp_path / "few", facts_file(tmp_path), tmp_path)
    assert "0.980" not in (tmp_path / "few/README.md").read_text()
    (tmp_path / "audit.json").write_text(json.dumps({**audit, "identity": "0" * 64}))
    with pytest.raises(UsageError, match="audit of another set"):
        publish(kept, tmp_path / "other", facts_file(tmp_path), tmp_path)


@pytest.mark.filterwarnings("ignore")
def test_the_header_has_the_features_that_datasets_would_write(kept: Path, published: Path) -> None:
    datasets = pytest.importorskip("datasets")
    header = yaml.safe_load((published / "README.md").read_text().split("---\n")[1])
    schema = next(siggen.open(kept).records()).schema
    features = datasets.Features.from_arrow_schema(schema)
    for name in ("state", "fault", "severity", "faulty_gear"):
        own = next(f for f in header["dataset_info"][0]["features"] if f["name"] == name)
        features[name] = datasets.ClassLabel(names=list(own["dtype"]["class_label"]["names"].values()))
    assert header["dataset_info"][0]["features"] == features._to_yaml_list()


def test_class_labels_name_the_gears_of_every_mesh_and_of_planetary_sets() -> None:
    named = [class_words(load_config(raw))["faulty_gear"] for raw in (staged(), planets())]
    assert named[0] == ("none", "pinion", "gear", "slow_pinion", "slow_gear", "several")
    assert named[1] == ("none", "sun", "planet", "ring", "several")


def test_every_number_of_a_machine_is_assumed_once() -> None:
    rows = assumed_numbers_section(siggen.load_config("two_stage")).splitlines()
    keys = [row.split("|")[1].strip() for row in rows if row.startswith("|")]
    assert len(keys) == len(set(keys))
