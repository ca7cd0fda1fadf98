"""A set whose gears, shafts and meshes have names of the user's own, read in the words that diagnostics counts by.

What is written about such a set goes through `Words`, which says the user's names again: in columns and in sentences of
the program alone. Values of labels, names of states, channels, files and sets stay as they are.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, TypeVar

import pyarrow as pa

from diagnostics.records.gear_train import GEARS
from diagnostics.records.own_words import BREAK, NO_WORDS, OwnWords, changed_beside, own_words
from siggen.dataset import reading
from siggen.dataset.reading import Dataset, RowGroup
from siggen.keys.column import Role

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Rows = TypeVar("Rows", pa.Table, pa.RecordBatch)
IDENTIFIER = re.compile(rf"(?:\w|{BREAK})*(?:pinion|gear)(?:\w|{BREAK})*")
"""Names of columns, which pages may break between their parts."""
PICTURE = re.compile(r"(;base64,[A-Za-z0-9+/=]+)")
OF_GEAR = re.compile(
    r"\bgear(?= (?:averages?|sidebands?|revolutions?|turns?|tooth|orders)\b)|(?<=, )gear(?=[,<\"]| [0-9])"
)
"""Where `gear` is the driven one of the first mesh, not any gear."""


@dataclass(frozen=True, slots=True)
class Words:
    """The user's names in texts, tables and figures about a set, but for data; without any, nothing changes."""

    names: OwnWords = NO_WORDS
    channels: frozenset[str] = frozenset()

    def __call__(self, text: str) -> str:
        """Return a text of the program with the user's names; pictures inside a page hold none."""
        if not self.names.gears:
            return text
        parts, kept = PICTURE.split(text), self.names.kept
        parts[::2] = [changed_beside(kept, part, self._said) for part in parts[::2]]
        return "".join(parts)

    def _said(self, text: str) -> str:
        text = IDENTIFIER.sub(self._identifier, text)
        for short, _ in self.names.meshes[1:]:
            text = self._about_mesh(short, text)
        return OF_GEAR.sub(self.names.gear("gear"), self.names.text(text))

    def column(self, name: str) -> str:
        """Return the user's name of a column; one that ends in the name of a mesh is about its gears."""
        own, behind, channel = name.partition("__")
        if "_" not in own or own in self.channels or name in self.names.kept:
            return name
        mesh = self._mesh(own)
        if not mesh or name.startswith("teeth_"):
            return f"{self.names.column(own)}{behind}{channel}"
        for role in GEARS:
            gear = self.names.gear(f"{mesh}.{role}").replace(".", "_")
            own = re.sub(rf"(?<![a-z0-9]){role}(?![a-z0-9])", gear, own)
        return f"{own}{behind}{channel}"

    def about(self, column: str, text: str) -> str:
        """Return a text about an indicator, by its column without the channel, with the user's names."""
        mesh = self._mesh(column)
        return self(self._in_mesh(mesh, text) if mesh else text)

    def _mesh(self, column: str) -> str:
        """Return the further mesh that a column is about, or nothing."""
        return next((short for short, _ in self.names.meshes[1:] if column.endswith(f"_{short}")), "")

    def _identifier(self, found: re.Match[str]) -> str:
        own = self.column(found[0].replace(BREAK, ""))
        return own.replace("_", f"_{BREAK}") if BREAK in found[0] else own

    def _about_mesh(self, mesh: str, text: str) -> str:
        """Return a text in which what sentences say of another mesh than the first has the names of its gears."""
        parts, done = [], 0
        for found in re.finditer(rf"\bmesh {mesh}\b", text):  # pictures inside pages are long: no search twice
            if found.start() >= done:
                start = max(done, *(text.rfind(sign, done, found.start()) + 1 for sign in "<>.;:"))
                ends = [text.find(sign, found.end()) for sign in "<>.;"]
                end = min((place for place in ends if place >= 0), default=len(text))
                parts += [text[done:start], self._in_mesh(mesh, text[start:end])]
                done = end
        return "".join([*parts, text[done:]])

    def _in_mesh(self, mesh: str, phrase: str) -> str:
        """Return a phrase about one mesh with the names of its gears."""
        for role in GEARS:
            phrase = re.sub(rf"\b{role}\b", self.names.gear(f"{mesh}.{role}"), phrase)
        return phrase

    def table(self, table: pa.Table) -> pa.Table:
        """Return a table with the user's names of columns, and in the columns that hold words of the program."""
        if not self.names.gears:
            return table
        columns = []
        for name, column in zip(table.column_names, table.columns, strict=True):
            said: Callable[[str], str] | None = {"indicator": self.column, "notes": self.__call__}.get(name)
            texts = [text and said(text) for text in column.to_pylist()] if said else None
            columns.append(pa.array(texts, column.type) if texts is not None else column)
        return pa.table(columns, names=[self.column(name) for name in table.column_names])

    def document(self, value: Any) -> Any:
        """Return a document whose columns and sentences have the user's names; what comes of data stays."""
        if not self.names.gears:
            return value
        if isinstance(value, Mapping):
            return {self._entry(key): self.document(item) for key, item in value.items()}
        if isinstance(value, (list, tuple)):
            return [self.document(item) for item in value]
        return self._entry(value) if isinstance(value, str) else value

    def _entry(self, text: str) -> str:
        """Return a column by its name, anything else as a sentence."""
        return self.column(text) if "_" in text and text.isidentifier() else self(text)

    def figure(self, figure: Figure) -> Figure:
        """Return a figure with the user's names in its texts."""
        if self.names.gears:
            from matplotlib.text import Text

            for text in figure.findobj(Text):
                text.set_text(self(text.get_text()))
        return figure


class NamedSet(Dataset):
    """A set with names of its own, whose columns have those of the program."""

    def read_as(self, names: OwnWords, short: Mapping[str, str]) -> NamedSet:
        """Return the set with the words of a machine: column of the files -> column here."""
        self.own_names, self._short = names, dict(short)
        self._own = {here: there for there, here in short.items()}
        return self

    @cached_property
    def words(self) -> Words:
        """What says the user's names, but for all that the set holds."""
        labels = self.labels()
        given = [name for name in labels.column_names if name not in self._own]
        values = (labels.column(name) for name in given if pa.types.is_string(labels.schema.field(name).type))
        texts = [text for column in values for text in column.unique().to_pylist() if text]
        channels = frozenset(channel.name for channel in self.channels)
        titles = (text.replace("_", " ") for name in channels for text in (name, name.rpartition("_")[0]))
        data = (*given, *texts, *channels, *titles, self.path, self.path.name, self.manifest.get("name", ""))
        return Words(self.own_names.keeping(data), channels)

    def labels(self, split: str | None = None, columns: Sequence[str] | None = None) -> pa.Table:
        """Return labels as `Dataset.labels`."""
        return self._renamed(super().labels(split, self._there(columns)))

    def role(self, name: str) -> Role:
        """Return a role as `Dataset.role`."""
        return super().role(self._own.get(name, name))

    def section(self, name: str) -> str:
        """Return a section as `Dataset.section`."""
        return super().section(self._own.get(name, name))

    def records(
        self, split: str | None = None, columns: Sequence[str] | None = None, batch_rows: int | None = None
    ) -> Iterator[pa.RecordBatch]:
        """Yield rows as `Dataset.records`."""
        return map(self._renamed, super().records(split, self._there(columns), batch_rows))

    def row_group(self, group: RowGroup, columns: Sequence[str] | None = None) -> pa.RecordBatch:
        """Return rows as `Dataset.row_group`."""
        return self._renamed(super().row_group(group, self._there(columns)))

    def record(self, record_id: int) -> dict[str, Any]:
        """Return a record as `Dataset.record`."""
        return {self._short.get(name, name): value for name, value in super().record(record_id).items()}

    def _there(self, columns: Sequence[str] | None) -> list[str] | None:
        return None if columns is None else [self._own.get(name, name) for name in columns]

    def _renamed(self, rows: Rows) -> Rows:
        fields = [field.with_name(self._short.get(field.name, field.name)) for field in rows.schema]
        return type(rows).from_arrays(rows.columns, schema=pa.schema(fields, rows.schema.metadata))


def open_set(path: PurePath | str) -> Dataset:
    """Return a set as diagnostics reads it; raises DatasetError as `siggen.open`."""
    dataset = reading.open(path)
    names, short = dataset.names()
    if not names.given:
        return dataset
    dataset.__class__ = NamedSet
    assert isinstance(dataset, NamedSet)
    return dataset.read_as(own_words(names), short)


def words_of(dataset: Dataset) -> Words:
    """Return what says the user's names of a set, but for what the set holds."""
    return dataset.words if isinstance(dataset, NamedSet) else Words()
