"""The message for a missing optional package: which one, what for, how to install it."""

from __future__ import annotations

import importlib.util

from siggen.errors import UsageError, how_to_install

EXTRA_OF = {
    "sklearn": "diagnostics",
    "matplotlib": "diagnostics",
    "skops": "diagnostics",
    "jinja2": "diagnostics",
    "torch": "cnn",
    "safetensors": "diagnostics",
    "nptdms": "recordings",
    "pyuff": "recordings",
    "h5py": "recordings",
    "asammdf": "mdf",
}
"""Import name of every optional package and the extra that brings it."""


def missing_packages(*names: str) -> tuple[str, ...]:
    """Return those of the named packages that cannot be imported."""
    return tuple(name for name in names if importlib.util.find_spec(name) is None)


def require_packages(purpose: str, *names: str) -> None:
    """Check that the named packages are installed, without importing them.

    Raises
    ------
    UsageError
        Naming the missing packages and how to install them.
    """
    missing = missing_packages(*names)
    if missing:
        extras = ",".join(sorted({EXTRA_OF[name] for name in missing}))
        raise UsageError(
            f"{purpose} needs {', '.join(missing)}, which {'is' if len(missing) == 1 else 'are'} not installed; "
            f"{how_to_install(extras)}"
        )
