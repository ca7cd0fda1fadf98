"""The network on averages on disk: as safetensors, which cannot execute anything.

The safetensors file carries classes, channels, identity of the set and temperature in its metadata.
"""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import load_file, save

from diagnostics.training.average_rows import ROWS
from diagnostics.training.cnn import CircularNetwork
from diagnostics.training.network_training import TrainedNetworkFile
from siggen.errors import UsageError
from siggen.file_writing import write_file

FORMAT = "siggen-diagnostics network on averages 1"


@dataclass(frozen=True, slots=True)
class NetworkFacts:
    """What a file of a network on averages says about it.

    Attributes
    ----------
    classes, channels : tuple of str
        States in the order of the outputs; channels in the order of the rows, see `average_rows`.
    identity : str
        Identity of the set it was trained on.
    temperature : float
        Applied to the mean probabilities of a recording's pieces; not in the network.
    """

    classes: tuple[str, ...]
    channels: tuple[str, ...]
    identity: str
    temperature: float = 1.0


def save_network(found: TrainedNetworkFile, path: Path) -> None:
    """Write weights and facts as safetensors; the facts are JSON under the metadata key `facts`."""
    trained = found.trained
    facts = NetworkFacts(trained.classes, found.channels, found.identity, trained.temperature)
    weights = {name: value.contiguous() for name, value in trained.network.state_dict().items()}
    write_file(path, save(weights, metadata={"format": FORMAT, "facts": json.dumps(asdict(facts))}))


def load_network(path: Path) -> tuple[CircularNetwork, NetworkFacts]:
    """Read a network written by `save_network`; nothing in the file is executed.

    Raises
    ------
    UsageError
        If the file is not one.
    """
    try:
        with safe_open(path, framework="pt") as file:
            metadata = file.metadata() or {}
    except (OSError, SafetensorError) as error:
        raise UsageError(f"{path}: cannot be read as safetensors ({error})") from error
    if metadata.get("format") != FORMAT:
        raise UsageError(f"{path}: received format {metadata.get('format')!r}; allowed is {FORMAT!r}")
    try:
        found = json.loads(metadata["facts"])
        facts = NetworkFacts(
            tuple(found["classes"]), tuple(found["channels"]), str(found["identity"]), float(found["temperature"])
        )
        network = CircularNetwork(ROWS * len(facts.channels), len(facts.classes))
        network.load_state_dict(load_file(path))
    except (KeyError, TypeError, ValueError, RuntimeError, SafetensorError) as error:
        text = str(error).splitlines()[0]
        raise UsageError(f"{path}: received facts or weights of another schema ({text}); train again") from error
    _check_finite(path, network, facts.temperature)
    network.eval()
    return network, facts


def _check_finite(path: Path, network: torch.nn.Module, temperature: float) -> None:
    infinite = [name for name, value in network.state_dict().items() if not bool(torch.isfinite(value).all())]
    if infinite:
        raise UsageError(f"{path}: received {infinite[0]} that is not finite; the file is damaged: train again")
    if not (math.isfinite(temperature) and temperature > 0.0):
        raise UsageError(f"{path}: received temperature {temperature}; allowed: finite and above 0; train again")
