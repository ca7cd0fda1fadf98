"""Weights of a network with facts about it, as safetensors, which cannot execute anything."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import load_file, save
from torch import nn

from siggen.errors import UsageError
from siggen.file_writing import write_file


def save_weights(network: nn.Module, path: Path, form: str, facts: Mapping[str, Any]) -> None:
    """Write weights and facts: JSON with the `format`, under the one metadata key `facts`."""
    weights = {name: value.contiguous() for name, value in network.state_dict().items()}
    # one key: safetensors writes several in an order of its own, another one at every call
    write_file(path, save(weights, metadata={"facts": json.dumps({"format": form, **facts})}))


def read_facts(path: Path, form: str) -> Any:
    """Return the facts of a file, as JSON holds them.

    Raises
    ------
    UsageError
        If the file is none of this format.
    """
    try:
        with safe_open(path, framework="pt") as file:
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


def load_weights(network: nn.Module, path: Path) -> None:
    """Give a network the weights of a file, and leave it in evaluation mode.

    Raises
    ------
    UsageError
        If they are of another network, or not finite.
    """
    try:
        network.load_state_dict(load_file(path))
    except (RuntimeError, SafetensorError) as error:
        raise other_schema(path, error) from error
    infinite = [name for name, value in network.state_dict().items() if not bool(torch.isfinite(value).all())]
    if infinite:
        raise UsageError(f"{path}: received {infinite[0]} that is not finite; the file is damaged: train again")
    network.eval()


def other_schema(path: Path, error: Exception) -> UsageError:
    """Return what is wrong with a file whose facts or weights are not what was expected."""
    text = str(error).splitlines()[0]
    return UsageError(f"{path}: received facts or weights of another schema ({text}); train again")
