"""Reading and writing a configuration's YAML: the plain rules of YAML 1.2, and no key twice.

PyYAML follows YAML 1.1, where 1e3 is a text, 010 is eight, 30:20 is 1820 and a state named `no` is false.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import yaml
from yaml.composer import Composer
from yaml.constructor import SafeConstructor
from yaml.reader import Reader
from yaml.resolver import Resolver

from siggen.errors import ConfigError, Problem, UsageError

FLOAT = re.compile(
    r"^[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?$|^[-+]?\.(?:inf|Inf|INF)$|^\.(?:nan|NaN|NAN)$"
)
INT = re.compile(r"^[-+]?[0-9]+$")
BOOL = re.compile(r"^(?:true|True|TRUE|false|False|FALSE)$")
NULL = re.compile(r"^(?:~|null|Null|NULL|)$")


LARGEST_BYTES = 1 << 22
"""Of a file: the stored configuration of a set with measured responses holds megabytes of them, as text."""

DEEPEST = 32
"""Mappings and lists within each other, aliases followed; a configuration needs eight."""

MOST_VALUES = 20_000
"""Keys and values of a file, those counted again that an alias repeats; presets have up to 3,000."""

MOST_NUMBERS = 30_000
"""Numbers in lists, which cost less than other values; more belong into a file that the configuration names."""

STORED_NUMBERS = 250_000
"""The same in the configuration of a set, into which the numbers of such files have gone."""


class _Refusal(yaml.YAMLError):
    """What YAML allows and a configuration does not."""

    def __init__(self, mark: Any, received: str, allowed: str) -> None:
        super().__init__(received)
        self.problem = Problem(f"line {mark.line + 1}", received, allowed)


class _Extent(NamedTuple):
    """How many values a node stands for, and how many mappings and lists lie within each other in it."""

    values: int
    height: int


_NUMBER = _Extent(1, 1)

if TYPE_CHECKING or not yaml.__with_libyaml__:
    _Reader = yaml.SafeLoader
else:

    class _Reader(Composer, yaml.cyaml.CParser, SafeConstructor, Resolver):
        """Scanned by libyaml, ten times faster; composed in Python, where values are counted before they are made."""

        def __init__(self, text: str) -> None:
            yaml.cyaml.CParser.__init__(self, text)
            for part in (Composer, SafeConstructor, Resolver):
                part.__init__(self)


class _Loader(_Reader):
    """SafeLoader with the numbers, booleans and nulls of YAML 1.2 and nothing else resolved."""

    yaml_implicit_resolvers = {}  # noqa: RUF012 - PyYAML's own, filled below

    def __init__(self, text: str, most_numbers: int = MOST_NUMBERS) -> None:
        super().__init__(text)
        self._most_numbers = most_numbers
        self.problems: list[Problem] = []
        self._extents: dict[yaml.Node, _Extent] = {}
        self._depth = 0
        self._values = 0
        self._numbers = 0

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        """Compose a node; refuses tags, aliases of what they stand in, and more or deeper values than are allowed."""
        if (number := self._number(parent)) is not None:
            return number
        event = self.peek_event()  # type: ignore[no-untyped-call]
        if isinstance(event, yaml.AliasEvent):
            return self._repeated(super().compose_node(parent, index), event.start_mark)
        if event.tag is not None:
            raise _Refusal(event.start_mark, f"the tag {event.tag[:60]}", "allowed: plain values, without tags")
        self._depth += 1
        self._count(1, self._depth, event.start_mark)
        before = self._values + self._numbers
        node = super().compose_node(parent, index)
        self._depth -= 1
        if node is not None:
            height = 1 + max((self._extents.get(child, _NUMBER).height for child in _children(node)), default=0)
            self._extents[node] = _Extent(1 + self._values + self._numbers - before, height)
        return node

    def _number(self, parent: yaml.Node | None) -> yaml.ScalarNode | None:
        """Return the next value of a list if it is a number, which goes a shorter way; None if it is anything else."""
        event: Any = self.peek_event()  # type: ignore[no-untyped-call]
        if not (isinstance(event, yaml.ScalarEvent) and isinstance(parent, yaml.SequenceNode)):
            return None
        if event.anchor is not None or event.tag is not None or not event.implicit[0]:
            return None
        kind = "int" if INT.match(event.value) else "float" if FLOAT.match(event.value) else ""
        if not kind:
            return None
        self._numbers += 1
        if self._numbers > self._most_numbers:
            received = f"{self._numbers} numbers in lists"
            raise _Refusal(event.start_mark, received, f"allowed: at most {self._most_numbers}; files take more")
        self.get_event()  # type: ignore[no-untyped-call]
        start: Any = event.start_mark
        end: Any = event.end_mark
        return yaml.ScalarNode(_tag(kind), event.value, start, end)

    def _repeated(self, node: yaml.Node | None, mark: Any) -> yaml.Node | None:
        """Return the node of an alias, counted with all that it stands for."""
        if node not in self._extents:
            raise _Refusal(mark, "an alias of the mapping or list that it stands in", "allowed: aliases that end")
        extent = self._extents[node]
        self._count(extent.values, self._depth + extent.height, mark)
        return node

    def _count(self, values: int, depth: int, mark: Any) -> None:
        self._values += values
        if depth > DEEPEST:
            received = f"{depth} mappings or lists within each other"
            raise _Refusal(mark, received, f"allowed: at most {DEEPEST}")
        if self._values > MOST_VALUES:
            received = f"{self._values} values, those repeated by aliases counted again"
            raise _Refusal(mark, received, f"allowed: at most {MOST_VALUES}")

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


def _list(dumper: yaml.SafeDumper, values: list[Any]) -> yaml.Node:
    """Represent a list of plain values on one line, as one would write a range."""
    plain = not any(isinstance(value, (list, dict)) for value in values)
    return dumper.represent_sequence("tag:yaml.org,2002:seq", values, flow_style=plain)


_Dumper.add_representer(list, _list)


def _children(node: yaml.Node) -> list[yaml.Node]:
    if isinstance(node, yaml.MappingNode):
        return [part for pair in node.value for part in pair]
    return node.value if isinstance(node, yaml.SequenceNode) else []


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
        If it is not YAML, has keys twice, is no mapping, or larger or deeper than allowed; with line numbers.
    """
    try:
        with Path(path).open("rb") as file:
            content = file.read(LARGEST_BYTES + 1)
        if len(content) > LARGEST_BYTES:
            line = content.count(b"\n") + 1
            received = f"more than {LARGEST_BYTES} bytes"
            raise ConfigError([Problem(f"line {line}", received, "allowed: smaller files")], str(path))
        text = content.decode("utf-8")
    except OSError as error:
        raise UsageError(f"{path}: cannot be read ({error.strerror}); give the path of a YAML file") from None
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise UsageError(f"{path}: is no text in UTF-8 (line {line}); give the path of a YAML file") from None
    return parse_yaml(text.removeprefix("\ufeff"), source=str(path))


def parse_yaml(text: str, source: str = "configuration", most_numbers: int = MOST_NUMBERS) -> dict[str, Any]:
    """Return the mapping that a YAML text stands for; raises ConfigError as `read_yaml` does."""
    value = yaml_value(text, source, most_numbers)
    if not isinstance(value, Mapping):
        received = "an empty file" if value is None else f"{type(value).__name__} at the top"
        raise ConfigError(
            [Problem("line 1", received, "allowed: a mapping with keys such as name, seed and gears")], source
        )
    return dict(value)


def yaml_node(text: str) -> yaml.Node | None:
    """Return the tree of nodes of a YAML text, which know their lines; None if it is empty or no YAML."""
    if Reader.NON_PRINTABLE.search(text):
        return None
    try:
        return _Loader(text).get_single_node()
    except yaml.YAMLError:
        return None


def yaml_value(text: str, source: str, most_numbers: int = MOST_NUMBERS) -> Any:
    """Return any value written in YAML; raises ConfigError with the line if it is not YAML or has keys twice."""
    if unprintable := Reader.NON_PRINTABLE.search(text):
        line = text.count("\n", 0, unprintable.start()) + 1
        received = f"the character #x{ord(unprintable.group()):04x}"
        raise ConfigError([Problem(f"line {line}", received, "allowed: text that can be printed")], source)
    try:
        loader = _Loader(text, most_numbers)
        value = loader.get_single_data()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"line {mark.line + 1}, column {mark.column + 1}" if mark else "the file"
        hint = "indent with spaces, not with tabs" if _has_tab(text, mark) else "allowed: valid YAML"
        raise ConfigError([Problem(where, f"what is no YAML ({error.problem})", hint)], source) from None
    except _Refusal as error:
        raise ConfigError([*loader.problems, error.problem], source) from None
    if loader.problems:
        raise ConfigError(loader.problems, source)
    return value


def _has_tab(text: str, mark: Any) -> bool:
    """Tell whether a tab stands at a place of a text, which only there is no space."""
    line = text.split("\n")[mark.line : mark.line + 1] if mark else []
    return bool(line) and line[0][mark.column : mark.column + 1] == "\t"


def yaml_text(mapping: Mapping[str, Any]) -> str:
    """Return a mapping as YAML, keys in their order; the same mapping always gives the same bytes."""
    return yaml.dump(dict(mapping), Dumper=_Dumper, sort_keys=False, default_flow_style=False)
