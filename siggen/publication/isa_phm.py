"""ISA-PHM metadata of a published set, as ISA-JSON: investigation, one study per state, one assay per channel.

Source: ISA Abstract Model 1.0 (investigation, study, assay, their materials, protocols and processes), and the
ISA-PHM working group's use of it: a study is one condition of health, its fault and operating conditions are factors,
an assay is one sensor. The set is of the kind that it calls a diagnostic experiment by numerical simulation.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from siggen.keys.number import Number, bounds
from siggen.publication.publication_facts import Author, PublicationFacts

if TYPE_CHECKING:
    from siggen.config import Config, Stage, State
    from siggen.config.names import Names

ISA_PHM = "i_investigation.json"
"""As the working group names the file."""

FACTORS = {
    "fault_type": ("Fault type", "Fault", ""),
    "fault_position": ("Fault position", "Fault", ""),
    "fault_severity": ("Fault severity", "Fault", ""),
    "speed": ("Speed of the pinion shaft", "Operating condition", "Hz"),
    "torque": ("Torque on the pinion shaft", "Operating condition", "N m"),
}
PARAMETERS = {
    "sampling_rate": "Sampling rate",
    "duration": "Duration of a record",
    "place": "Sensor location",
    "axis": "Sensor orientation",
    "column": "Column of the data files",
    "quantity": "Quantity that is measured",
    "unit": "Unit of the column",
    "rows": "Rows of the data files",
}
UNITS = ("Hz", "N m", "s", "mm")


def isa_phm(
    config: Config,
    facts: PublicationFacts,
    description: str,
    channels: Sequence[Mapping[str, str]],
    data_files: Sequence[str],
) -> dict[str, Any]:
    """Return the investigation; `channels` as in the manifest, `data_files` by their names in the published folder."""
    return {
        "identifier": facts.doi or facts.url,
        "title": facts.title,
        "description": description,
        **_dates(facts),
        "comments": [_comment("experiment_type", "diagnostic"), _comment("data_source", "numerical simulation")],
        "ontologySourceReferences": [],
        "people": [_person(author) for author in facts.authors],
        "publications": [],
        "studies": [_study(config, facts, state, channels, data_files) for state in config.states],
    }


def _study(
    config: Config, facts: PublicationFacts, state: State, channels: Sequence[Mapping[str, str]], files: Sequence[str]
) -> dict[str, Any]:
    samples = list(_samples(config, state))
    return {
        "filename": f"s_{state.name}.txt",
        "identifier": state.name,
        "title": state.name,
        "description": f"All gearboxes of the set in the state {state.name}: fault {state.fault}, {state.severity}.",
        **_dates(facts),
        "comments": [],
        "publications": [],
        "people": [_person(author) for author in facts.authors],
        "studyDesignDescriptors": [_term("design/diagnostic", "diagnostic experiment")],
        "protocols": list(_protocols()),
        "materials": {"sources": [_source(config)], "samples": samples, "otherMaterials": []},
        "processSequence": [_process("damage", "damage", ["#source/gear_pair"], [one["@id"] for one in samples])],
        "factors": [
            {
                "@id": f"#factor/{key}",
                "factorName": config.names.text(name),
                "factorType": _term(f"factor_type/{key}", kind),
                "comments": [],
            }
            for key, (name, kind, _) in FACTORS.items()
        ],
        "characteristicCategories": list(_categories(config)),
        "unitCategories": [_term(f"unit/{unit.replace(' ', '_')}", unit) for unit in UNITS],
        "assays": [_assay(config, state, channel, samples, files) for channel in channels],
    }


def _assay(
    config: Config,
    state: State,
    channel: Mapping[str, str],
    samples: Sequence[Mapping[str, Any]],
    files: Sequence[str],
) -> dict[str, Any]:
    where = f"{state.name}/{channel['name']}"
    sensor = next(one for one in config.sensors if channel["name"] in dict(one.channels))
    measurement = sensor.quantity.measurement or sensor.quantity.word
    outputs = [f"#data_file/{where}/{file}" for file in files]
    values: dict[str, dict[str, Any]] = {
        "sampling_rate": {"value": float(config.fs_hz), **_unit("Hz")},
        "duration": {"value": float(config.duration_s), **_unit("s")},
        "place": {"value": channel["place"]},
        "axis": {"value": channel["axis"]},
        "column": {"value": channel["column"]},
        "quantity": {"value": sensor.quantity.word},
        "unit": {"value": sensor.quantity.unit},
        "rows": {"value": f"state = {state.name}"},
    }
    parameters = [{"category": {"@id": f"#parameter/{key}"}, **value} for key, value in values.items()]
    process = _process(f"measurement/{where}", "measurement", [one["@id"] for one in samples], outputs, parameters)
    return {
        "filename": f"a_{state.name}_{channel['name']}.txt",
        "measurementType": _term(f"measurement/{measurement.replace(' ', '_')}", measurement),
        "technologyType": _term(f"technology/{sensor.noun.replace(' ', '_')}", f"simulated {sensor.noun}"),
        "technologyPlatform": "siggen",
        "comments": [_comment("sensor alias", channel["name"])],
        "characteristicCategories": [],
        "unitCategories": [],
        "materials": {"samples": [{"@id": one["@id"]} for one in samples], "otherMaterials": []},
        "dataFiles": [
            {"@id": output, "name": file, "type": "Raw Data File", "comments": []}
            for output, file in zip(outputs, files, strict=True)
        ],
        "processSequence": [process],
    }


def _position(config: Config, state: State) -> str:
    """Return where a state is damaged, as the configuration names it."""
    names = {**config.names.places, **config.names.damaged}
    named = dict.fromkeys(names.get(one.position, one.position) for one in state.damages)
    return " and ".join(named) if state.damaged else "none"


def _samples(config: Config, state: State) -> Iterator[dict[str, Any]]:
    """Yield the gear pair in a state at each operating point."""
    position = _position(config, state)
    fault = {"fault_type": state.fault, "fault_position": position, "fault_severity": state.severity}
    for number, point in enumerate(config.operating_points):
        conditions = {"speed": _range(point.speed_hz), "torque": _range(point.torque_nm)}
        yield {
            "@id": f"#sample/{state.name}/{number}",
            "name": f"{state.name}, operating point {number}",
            "characteristics": [],
            "factorValues": [
                {"category": {"@id": f"#factor/{key}"}, "value": value, **_unit(FACTORS[key][2])}
                for key, value in {**fault, **conditions}.items()
            ],
            "derivesFrom": [{"@id": "#source/gear_pair"}],
            "comments": [],
        }


def _characteristics(config: Config) -> dict[str, tuple[str, float | str, str]]:
    """Return key -> name, value, unit of what a reader has to know of the pair; ranges where a set has several."""
    gears, names = config.gears, config.names
    widths = _span([pair.face_width_mm for pair in gears.pairs]) or _range(gears.face_width_mm)
    # numbers without a unit are texts: isatools 0.14 does not load them otherwise
    return {
        "gearboxes": ("Number of gearboxes", str(config.specimens), ""),
        **{
            names.column(f"teeth_{gear}"): (names.text(f"Teeth of the {gear}"), str(_span(gears.teeth_of(gear))), "")
            for gear in ("pinion", "gear")
        },
        "module": ("Normal module", _span([pair.module_mm for pair in gears.pairs]) or _range(gears.module_mm), "mm"),
        "face_width": ("Face width", widths, "mm"),
        **{key: value for stage in config.stages for key, value in _of_stage(stage, names)},
    }


def _of_stage(stage: Stage, names: Names) -> Iterator[tuple[str, tuple[str, float | str, str]]]:
    for gear in ("pinion", "gear"):
        teeth = str(stage.gears.teeth_of(gear)[0])
        yield names.column(f"teeth_{stage.name}_{gear}"), (names.text(f"Teeth of the {stage.name}.{gear}"), teeth, "")
    for key, name in (("module", "Normal module"), ("face_width", "Face width")):
        yield f"{key}_{stage.name}", (f"{name} of {stage.name}", _range(getattr(stage.gears, f"{key}_mm")), "mm")


def _factors() -> Iterator[dict[str, Any]]:
    for key, (name, kind, _) in FACTORS.items():
        kind_of = _term(f"factor_type/{key}", kind)
        yield {"@id": f"#factor/{key}", "factorName": name, "factorType": kind_of, "comments": []}


def _categories(config: Config) -> Iterator[dict[str, Any]]:
    for key, (name, _, _) in _characteristics(config).items():
        yield {"@id": f"#characteristic/{key}", "characteristicType": _term(f"characteristic_type/{key}", name)}


def _source(config: Config) -> dict[str, Any]:
    return {
        "@id": "#source/gear_pair",
        "name": "simulated gear pair",
        "comments": [_comment("configuration", "config.yaml")],
        "characteristics": [
            {"category": {"@id": f"#characteristic/{key}"}, "value": value, "comments": [], **_unit(unit)}
            for key, (_, value, unit) in _characteristics(config).items()
        ],
    }


def _protocols() -> Iterator[dict[str, Any]]:
    for name, kind, parameters in (
        ("damage", "numerical simulation of damage", ()),
        ("measurement", "numerical simulation of dynamics and sensor", tuple(PARAMETERS)),
    ):
        yield {
            "@id": f"#protocol/{name}",
            "name": name,
            "protocolType": _term(f"protocol_type/{name}", kind),
            "description": "",
            "uri": "",
            "version": "",
            "comments": [],
            "components": [],
            "parameters": [
                {"@id": f"#parameter/{key}", "parameterName": _term(f"parameter_name/{key}", PARAMETERS[key])}
                for key in parameters
            ],
        }


def _process(
    name: str, protocol: str, inputs: Sequence[str], outputs: Sequence[str], parameters: Sequence[dict[str, Any]] = ()
) -> dict[str, Any]:
    return {
        "@id": f"#process/{name}",
        "name": name,
        "performer": "",
        "date": "",
        "comments": [],
        "executesProtocol": {"@id": f"#protocol/{protocol}"},
        "parameterValues": list(parameters),
        "inputs": [{"@id": one} for one in inputs],
        "outputs": [{"@id": one} for one in outputs],
    }


def _person(author: Author) -> dict[str, Any]:
    family, _, given = (part.strip() for part in author.name.partition(","))
    return {
        **dict.fromkeys(("address", "email", "fax", "midInitials", "phone"), ""),
        "firstName": given,
        "lastName": family,
        "affiliation": author.affiliation or "",
        "roles": [_term("role/author", "author")],
        "comments": [_comment("orcid", author.orcid)] if author.orcid else [],
    }


def _dates(facts: PublicationFacts) -> dict[str, str]:
    return {"submissionDate": facts.published, "publicReleaseDate": facts.published}


def _range(number: Number) -> float | str:
    return _span(bounds(number))


def _span(values: Sequence[float]) -> float | str:
    """Return the value, or the least and the largest as text; an empty text for none."""
    if not values:
        return ""
    least, most = min(values), max(values)
    return least if least == most else f"{least:g} to {most:g}"


def _unit(unit: str) -> dict[str, dict[str, str]]:
    return {"unit": {"@id": f"#unit/{unit.replace(' ', '_')}"}} if unit else {}


def _term(name: str, text: str) -> dict[str, Any]:
    return {"@id": f"#{name}", "annotationValue": text, "termSource": "", "termAccession": "", "comments": []}


def _comment(name: str, value: str) -> dict[str, str]:
    return {"name": name, "value": value}
