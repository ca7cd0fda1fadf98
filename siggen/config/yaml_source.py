"""Reading and writing a configuration's YAML: the plain rules of YAML 1.2, and no key twice.

PyYAML follows YAML 1.1, where 1e3 is a text, 010 is eight, 30:20 is 1820 and a state named `no` is false.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from siggen.errors import ConfigError, Problem, UsageError

FLOAT = re.compile(
    r"^[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?$|^[-+]?\.(?:inf|Inf|INF)$|^\.(?:nan|NaN|NAN)$"
)
INT = re.compile(r"^[-+]?[0-9]+$")
BOOL = re.compile(r"^(?:true|True|TRUE|false|False|FALSE)$")
NULL = re.compile(r"^(?:~|null|Null|NULL|)$")


class _Loader(yaml.SafeLoader):
    """SafeLoader with the numbers, booleans and nulls of YAML 1.2 and nothing else resolved."""

    yaml_implicit_resolvers = {}  # noqa: RUF012 - PyYAML's own, filled below

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.problems: list[Problem] = []

    def compose_mapping_node(self, anchor: Any) -> yaml.MappingNode:
        """Compose a mapping as it is written, noting keys that come twice or are no text."""
        node = super().compose_mapping_node(anchor)
        first_lines: dict[str, int] = {}
        for key_node, _ in node.value:
            line = key_node.start_mark.line + 1
            if not isinstance(key_node, yaml.ScalarNode) or key_node.tag not in {_tag("str"), _tag("merge")}:
                self.problems.append(
                    Problem(f"line {line}", f"the key {_key_text(key_node)}", "allowed: keys that are texts")
                )
            elif key_node.value in first_lines:
                received = f"the key '{key_node.value}' a second time, first on line {first_lines[key_node.value]}"
                self.problems.append(Problem(f"line {line}", received, "allowed: every key once per mapping"))
            else:
                first_lines[key_node.value] = line
        return node

    def get_single_data(self) -> Any:
        """Return the value of the only document, or None if keys are wrong (see `problems`)."""
        node = self.get_single_node()
        return None if node is None or self.problems else self.construct_document(node)

    def construct_number(self, node: yaml.ScalarNode) -> int | float:
        """Construct a whole number or a float from its decimal digits."""
        text = str(self.construct_scalar(node))
        if node.tag == _tag("int") and len(text) < 400:  # Python refuses thousands of digits; as a float they are inf
            return int(text)
        return float(text.replace(".inf", "inf").replace(".Inf", "inf").replace(".INF", "inf").replace(".nan", "nan"))


class _Dumper(yaml.SafeDumper):
    """SafeDumper that also quotes texts which YAML 1.2 would read as numbers."""

    def ignore_aliases(self, data: object) -> bool:  # noqa: ARG002 - PyYAML's signature
        """Write everything out; an anchor would make the file harder to read."""
        return True


def _tag(name: str) -> str:
    return f"tag:yaml.org,2002:{name}"


def _key_text(node: yaml.Node) -> str:
    return str(node.value) if isinstance(node, yaml.ScalarNode) else "that is a list or a mapping"


for _name, _pattern, _first in (
    ("bool", BOOL, "tTfF"),
    ("int", INT, "-+0123456789"),
    ("float", FLOAT, "-+.0123456789"),
    ("null", NULL, "~nN\0"),
    ("merge", re.compile(r"^<<$"), "<"),
):
    _Loader.add_implicit_resolver(_tag(_name), _pattern, [c if c != "\0" else "" for c in _first])
_Loader.add_constructor(_tag("int"), _Loader.construct_number)
_Loader.add_constructor(_tag("float"), _Loader.construct_number)
_Dumper.add_implicit_resolver(_tag("float"), FLOAT, list("-+.0123456789"))


def read_yaml(path: str | Path) -> dict[str, Any]:
    """Return the mapping in a YAML file.

    Raises
    ------
    UsageError
        If the file cannot be read.
    ConfigError
        If it is not YAML, has keys twice, or is no mapping; with line numbers.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise UsageError(f"{path}: cannot be read ({error.strerror}); give the path of a YAML file") from None
    except UnicodeDecodeError:
        raise UsageError(f"{path}: is no text in UTF-8; give the path of a YAML file") from None
    return parse_yaml(text, source=str(path))


def parse_yaml(text: str, source: str = "configuration") -> dict[str, Any]:
    """Return the mapping that a YAML text stands for; raises ConfigError as `read_yaml` does."""
    value = yaml_value(text, source)
    if not isinstance(value, Mapping):
        received = "an empty file" if value is None else f"{type(value).__name__} at the top"
        raise ConfigError(
            [Problem("the file", received, "allowed: a mapping with keys such as name, seed and gears")], source
        )
    return dict(value)


def yaml_node(text: str) -> yaml.Node | None:
    """Return the tree of nodes of a YAML text, which know their lines; None if it is empty or no YAML."""
    try:
        return _Loader(text).get_single_node()
    except yaml.YAMLError:
        return None


def yaml_value(text: str, source: str) -> Any:
    """Return any value written in YAML; raises ConfigError with the line if it is not YAML or has keys twice."""
    try:
        loader = _Loader(text)
        value = loader.get_single_data()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"line {mark.line + 1}, column {mark.column + 1}" if mark else "the file"
        hint = "indent with spaces, not with tabs" if "'\\t'" in str(error.problem) else "allowed: valid YAML"
        raise ConfigError([Problem(where, f"what is no YAML ({error.problem})", hint)], source) from None
    except yaml.YAMLError as error:
        raise ConfigError([Problem("the file", str(error).splitlines()[0], "allowed: valid YAML")], source) from None
    if loader.problems:
        raise ConfigError(loader.problems, source)
    return value


def yaml_text(mapping: Mapping[str, Any]) -> str:
    """Return a mapping as YAML, keys in their order; the same mapping always gives the same bytes."""
    return yaml.dump(dict(mapping), Dumper=_Dumper, sort_keys=False, default_flow_style=False)
