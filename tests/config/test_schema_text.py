"""The JSON Schema that `siggen init` writes: editors that follow it accept what the package does, and show meanings."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

from siggen.config import Config, read_yaml
from siggen.config.expert_keys import schema_text
from siggen.damage.registry import BY_WORD


@pytest.fixture(scope="module")
def schema():
    return json.loads(schema_text())


def resolved(schema, node):
    return schema["$defs"][node["$ref"].rsplit("/", 1)[1]] if "$ref" in node else node


def test_the_schema_names_every_key_and_what_is_needed(schema):
    assert list(schema["properties"]) == [
        *(name for name, field in Config.model_fields.items() if not field.exclude),
        "extends",
    ]
    assert set(schema["else"]["required"]) == {
        "name",
        "seed",
        "specimens",
        "operating_points",
        "sensors",
    }
    assert schema["else"]["allOf"] == [
        {"anyOf": [{"required": ["gears"]}, {"required": ["machine"]}]},
        {"anyOf": [{"required": ["states"]}, {"required": ["life"]}]},
    ]
    assert schema["additionalProperties"] is False


def test_every_key_of_every_section_is_described(schema):
    for name, section in {"Config": schema, **schema["$defs"]}.items():
        for key, field in section.get("properties", {}).items():
            is_distribution = name in {"LogUniform", "Normal", "Choice"}
            assert is_distribution or key == "kind" or "description" in resolved(schema, field) | field, f"{name}.{key}"


def test_a_number_may_be_a_constant_in_range_or_a_distribution(schema):
    width = schema["$defs"]["GearsSection"]["properties"]["face_width_mm"]
    number, *ranges = width["anyOf"]
    assert number == {"exclusiveMinimum": 0, "type": "number"}
    assert [resolved(schema, choice)["title"] for choice in ranges] == ["Uniform", "LogUniform", "Normal", "Choice"]


def test_words_beside_numbers_are_shown(schema):
    assert {"type": "null"} in schema["$defs"]["GearsSection"]["properties"]["centre_distance_mm"]["anyOf"]
    height = schema["$defs"]["LayeredPits"]["properties"]["first_height_mm"]
    assert any(choice.get("const") == "pitch" for choice in height["anyOf"])


def test_damage_is_chosen_by_its_kind(schema):
    damage = schema["$defs"]["StateSection"]["properties"]["damage"]
    found = [set(mapping) for mapping in _mappings(damage)]
    assert found
    assert all(kinds == set(BY_WORD) for kinds in found)


def _mappings(part):
    """Yield the kinds that a part of the schema chooses from, of one section and of a list of them."""
    if isinstance(part, dict):
        if "discriminator" in part:
            yield part["discriminator"]["mapping"]
        for inner in part.values():
            yield from _mappings(inner)
    for inner in part if isinstance(part, list) else ():
        yield from _mappings(inner)


@pytest.fixture(scope="module")
def editor(schema):
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.mark.parametrize("name", ["paper_b", "quickstart", "paper_a", "bench"])
def test_an_editor_with_the_schema_accepts_the_shipped_configurations(editor, name):
    editor.validate(read_yaml(f"configs/{name}.yaml"))


def test_an_editor_with_the_schema_marks_a_misspelt_key(editor):
    wrong = {**read_yaml("tests/configs/linear_pits.yaml"), "specimen": 3}
    with pytest.raises(jsonschema.ValidationError, match="specimen"):
        editor.validate(wrong)
    wrong = read_yaml("configs/quickstart.yaml")
    wrong["states"]["severe"]["damage"] = {"face_shear": 1.0}
    with pytest.raises(jsonschema.ValidationError, match="face_shear"):
        editor.validate(wrong)


def written(value, keys):
    """Every key that a file sets anywhere."""
    for key, item in value.items() if isinstance(value, dict) else ():
        keys.add(key)
        written(item, keys)
    for item in value if isinstance(value, list) else ():
        written(item, keys)
    return keys


def test_expert_keys_are_those_that_no_shipped_file_sets(schema):
    used = set()
    for path in Path("configs").glob("*.yaml"):
        written(read_yaml(path), used)
    marked = {
        (name, key): field.get("x-expert", False)
        for name, section in {"Config": schema, **schema["$defs"]}.items()
        for key, field in section.get("properties", {}).items()
        if name not in {"LogUniform", "Normal", "Choice"}
    }
    experts = {key for (_, key), expert in marked.items() if expert}
    # A name may occur in several sections, so a key that is written nowhere is one for experts, but not the reverse.
    sections = (schema["else"], *schema["$defs"].values())
    needed = {key for section in sections for key in section.get("required", ())}
    needed |= {"kind", "extends"}
    assert {key for _, key in marked} - used - needed <= experts
    assert not marked["MeshSection", "damage"]
    assert not marked["Config", "seed"]
    assert not marked["Stiffness", "beam"]
    assert {
        name
        for name, section in schema["$defs"].items()
        for key in section.get("required", ())
        if marked.get((name, key))
    } == set()
