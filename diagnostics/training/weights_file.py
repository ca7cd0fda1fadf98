"""Weights of a network with facts about it, as safetensors, which cannot execute anything."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import load_file, save

from siggen.errors import UsageError
from siggen.file_writing import write_file


def save_arrays(arrays: Mapping[str, np.ndarray], path: Path, form: str, facts: Mapping[str, Any]) -> None:
    """Write arrays and facts: JSON with the `format`, under the one metadata key `facts`."""
    whole = {name: np.ascontiguousarray(array) for name, array in arrays.items()}
    # one key: safetensors writes several in an order of its own, another one at every call
    write_file(path, save(whole, metadata={"facts": json.dumps({"format": form, **facts})}))


def save_weights(network: Any, path: Path, form: str, facts: Mapping[str, Any]) -> None:
    """Write the weights of a network of PyTorch as `save_arrays` does."""
    save_arrays({name: value.numpy() for name, value in network.state_dict().items()}, path, form, facts)


def read_facts(path: Path, form: str) -> Any:
    """Return the facts of a file, as JSON holds them.

    Raises
    ------
    UsageError
        If the file is none of this format.
    """
    try:
        with safe_open(path, framework="np") as file:
            metadata = file.metadata() or {}
    except (OSError, SafetensorError) as error:
        raise UsageError(f"{path}: cannot be read as safetensors ({error})") from error
    try:
        facts = json.loads(metadata.get("facts", "{}"))
    except ValueError as error:
        raise other_schema(path, error) from error
    held = facts.get("format") if isinstance(facts, dict) else None
    if held != form:
        raise UsageError(f"{path}: received format {held!r}; allowed is {form!r}")
    return facts


def load_arrays(path: Path) -> dict[str, np.ndarray]:
    """Return the arrays of a file.

    Raises
    ------
    UsageError
        If it cannot be read, or one is not finite.
    """
    try:
        arrays: dict[str, np.ndarray] = load_file(path)
    except SafetensorError as error:
        raise other_schema(path, error) from error
    infinite = [name for name, array in arrays.items() if not bool(np.isfinite(array).all())]
    if infinite:
        raise UsageError(f"{path}: received {infinite[0]} that is not finite; the file is damaged: train again")
    return arrays


def load_weights(network: Any, path: Path) -> None:
    """Give a network of PyTorch the weights of a file, and leave it in evaluation mode.

    Raises
    ------
    UsageError
        If they are of another network, or not finite.
    """
    import torch

    arrays = load_arrays(path)
    try:
        network.load_state_dict({name: torch.from_numpy(array) for name, array in arrays.items()})
    except RuntimeError as error:
        raise other_schema(path, error) from error
    network.eval()


def other_schema(path: Path, error: Exception) -> UsageError:
    """Return what is wrong with a file whose facts or weights are not what was expected."""
    text = str(error).splitlines()[0]
    return UsageError(f"{path}: received facts or weights of another schema ({text}); train again")
