"""Options of a command that belong together, as one dataclass: typer itself takes one parameter per option.

    @dataclass(frozen=True)
    class Picture:
        '''A picture beside the table.'''

        png: Annotated[Path | None, typer.Option(help="...")] = None

    @grouped
    def path(config: Path, *, picture: Picture) -> None: ...

The first line of the dataclass heads its options in the help.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from copy import copy
from dataclasses import fields, is_dataclass
from functools import wraps
from inspect import Parameter, Signature
from typing import Annotated, Any, get_type_hints


def grouped(command: Callable[..., None]) -> Callable[..., None]:
    """Return the command with every parameter that is a dataclass replaced by its fields, in their order.

    The fields are annotated as parameters of a typer command are; their names differ from those of all others.
    """
    hints = get_type_hints(command, include_extras=True)
    groups: dict[str, Any] = {name: hint for name, hint in hints.items() if is_dataclass(hint)}
    parameters = [
        option
        for name, parameter in inspect.signature(command).parameters.items()
        for option in (
            _options(groups[name])
            if name in groups
            else [parameter.replace(annotation=hints[name], kind=Parameter.KEYWORD_ONLY)]
        )
    ]

    @wraps(command)
    def run(**given: Any) -> None:
        packed = {
            name: group(**{field.name: given.pop(field.name) for field in fields(group)})
            for name, group in groups.items()
        }
        command(**given, **packed)

    run.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return run


def _options(group: Any) -> Iterator[Parameter]:
    """Yield the options of a group, all under its heading."""
    heading = (inspect.getdoc(group) or "").split("\n")[0].rstrip(".")
    hints = get_type_hints(group, include_extras=True)
    for field in fields(group):
        (option,) = hints[field.name].__metadata__
        headed = copy(option)
        headed.rich_help_panel = heading
        annotation: Any = Annotated[hints[field.name].__origin__, headed]
        yield Parameter(field.name, Parameter.KEYWORD_ONLY, default=field.default, annotation=annotation)
