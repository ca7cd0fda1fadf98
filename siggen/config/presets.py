"""The configurations that come with siggen, found by name: in a wheel inside the package, in a checkout beside it."""

from __future__ import annotations

from pathlib import Path

from siggen.errors import UsageError
from siggen.keys.data_file import is_file, kind_of_path, shortened_path
from siggen.keys.problems import nearest

SUFFIX = ".yaml"
PACKAGE = Path(__file__).resolve().parents[1]
FOLDERS = (PACKAGE / "presets", PACKAGE.parent / "configs")
"""Where a wheel has them (see `force-include` in pyproject.toml), and where they are written."""


def presets() -> dict[str, Path]:
    """Return name -> file of every preset, by name; empty in an installation that was cut down."""
    folder = next((folder for folder in FOLDERS if folder.is_dir()), FOLDERS[0])
    return {path.stem: path for path in sorted(folder.glob(f"*{SUFFIX}"))}


def config_file(source: str | Path) -> Path:
    """Return the file that a user means: the one of this path, or else the preset of this name, such as `quickstart`.

    Raises
    ------
    UsageError
        If there is neither; names the presets.
    """
    path = Path(source)
    if is_file(path):
        return path
    shipped = presets()
    if path.parent == Path() and path.name.removesuffix(SUFFIX) in shipped:
        return shipped[path.name.removesuffix(SUFFIX)]
    shown, what = shortened_path(source), kind_of_path(path)
    names = [*(shipped if path.parent == Path() else ()), *_names_beside(path)]
    meant = nearest(path.stem, names) or ";"
    raise UsageError(f"{shown}: {what}{meant} allowed are the path of a YAML file, or a preset: {', '.join(shipped)}")


def _names_beside(path: Path) -> list[str]:
    try:
        return [file.stem for file in path.parent.glob(f"*{SUFFIX}")]
    except (OSError, ValueError):
        return []
