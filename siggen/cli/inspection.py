"""What `siggen inspect` was asked for: which gearbox, state, mesh and tooth, and where table, picture or JSON go."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from siggen.cli.echo import echo
from siggen.cli.json_output import echo_json
from siggen.cli.picture_option import PictureOptions
from siggen.cli.working import working
from siggen.errors import UsageError, counted

if TYPE_CHECKING:
    import pyarrow as pa

    from siggen.gearbox.design import SetDesign
    from siggen.gearbox.specimen import Specimen


@dataclass(frozen=True, slots=True, kw_only=True)
class Inspection:
    """One look at one gearbox.

    Attributes
    ----------
    what : word behind `siggen inspect`
    options : those that it takes beside --gearbox, --set and --json
    source : YAML file, preset or folder of a set
    gearbox : its number in the set
    states : names; none: those that the view takes by default
    mesh : name, None for the view's default
    tooth : `INDEX` or `GEAR:INDEX`, None for the first damaged one
    torque_nm : on the pinion, None for that of the first operating point
    vary : `KEY=VALUES`, or nothing
    overrides : `PATH=VALUE`
    out : table to write
    """

    what: str
    options: Collection[str]
    source: Path
    gearbox: int
    states: Sequence[str]
    mesh: str | None
    tooth: str | None
    torque_nm: float | None
    vary: str
    overrides: Sequence[str]
    out: Path | None
    picture: PictureOptions
    as_json: bool

    def png(self, *, prints: bool = False, endings: Sequence[str] = ()) -> Path | None:
        """Return where the picture goes, if one is wanted; check it and the table before long work.

        Parameters
        ----------
        prints : bool
            Whether the view prints something of its own.
        endings : sequence of str
            Of the file to write where it is no table.

        Raises
        ------
        UsageError
            If neither can go there, or nothing is wanted.
        """
        from siggen.dataset.table_file import check_table_file

        png = self.picture.place(self.what)
        if self.out is None:
            if png is None and not self.as_json and not prints:
                ending = endings[0] if endings else ".csv"
                ways = {
                    "--out": f"--out {self.what}{ending}",
                    "--png": f"--png {self.what}.png for the picture",
                    "--open": "--open to see it",
                    "--json": "--json for the numbers",
                }
                named = ", ".join(way for option, way in ways.items() if option in {*self.options, "--json"})
                raise UsageError(f"siggen inspect {self.what}: nothing to write; give {named}")
        elif not endings:
            check_table_file(self.out)
        elif self.out.suffix.lower() not in endings:
            allowed = ", ".join(endings)
            raise UsageError(f"--out {self.out}: received the ending {self.out.suffix!r}; allowed are {allowed}")
        return png

    def design(self, further: Sequence[str] = ()) -> SetDesign:
        """Return the design of the set, with further overrides behind those of the user.

        Raises
        ------
        UsageError
            If it has no gearbox of that number.
        """
        from siggen.checks.loading import load_config

        source = self.source / "config.yaml" if self.source.is_dir() else self.source
        design = load_config(source, [*self.overrides, *further])
        if self.gearbox >= design.specimens:
            has = counted(design.specimens, "gearbox", "gearboxes")
            raise UsageError(
                f"--gearbox {self.gearbox}: {self.source} has {has}, 0 to {design.specimens - 1}; "
                f"--set specimens={self.gearbox + 1} gives it that one"
            )
        return design

    def drawn(self, design: SetDesign) -> tuple[Specimen, int]:
        """Return the gearbox, and the number of the chosen mesh, 0 for the first one.

        Raises
        ------
        UsageError
            If the gearbox has no mesh of that name.
        """
        from siggen.views.chosen_mesh import chosen_mesh

        gearbox = design.gearbox(self.gearbox)
        return gearbox, chosen_mesh(gearbox, self.mesh, "--mesh")

    @property
    def state(self) -> str | None:
        """Name of the state; None where none is chosen.

        Raises
        ------
        UsageError
            If several are.
        """
        if len(self.states) > 1:
            raise UsageError(f"--state: siggen inspect {self.what} takes one; received {', '.join(self.states)}")
        return self.states[0] if self.states else None

    def hand_over(
        self,
        table: pa.Table | None,
        draw: Callable[[Path], None],
        png: Path | None,
        facts: Callable[[], object] | None = None,
    ) -> None:
        """Write the table, draw the picture and print the JSON, as far as they are wanted; say where they are.

        Parameters
        ----------
        table : Table or None
            What goes to `out`.
        draw : callable
            Draws the picture into a file.
        png : Path or None
            Where it goes.
        facts : callable
            Returns what JSON holds; by default the rows of the table.
        """
        from siggen.dataset.table_file import write_table_file

        if self.out is not None and table is not None:
            write_table_file(table, self.out)
        if png is not None:
            with working("drawing the picture", compiles=False):
                draw(png)
        if self.as_json:
            rows: Any = facts() if facts is not None else {self.what: table.to_pylist() if table is not None else []}
            echo_json(rows)
        if self.out is not None and table is not None:
            echo(str(self.out), err=self.as_json)
        if png is not None:
            self.picture.drawn(png, err=self.as_json)
