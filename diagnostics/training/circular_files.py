"""The network on averages on disk: as safetensors, which cannot execute anything.

The safetensors file carries classes, channels, identity of the set and temperature in its metadata.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from safetensors import SafetensorError, safe_open
from safetensors.torch import load_file, save

from diagnostics.training.average_rows import ROWS
from diagnostics.training.circular_network import CircularNetwork
from diagnostics.training.circular_training import TrainedCircularFile
from diagnostics.training.cnn_files import check_finite
from siggen.errors import UsageError
from siggen.file_writing import write_file

FORMAT = "siggen-diagnostics circular network 1"


@dataclass(frozen=True, slots=True)
class CircularFacts:
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


def save_circular(found: TrainedCircularFile, path: Path) -> None:
    """Write weights and facts as safetensors; the facts are JSON under the metadata key `facts`."""
    trained = found.trained
    facts = CircularFacts(trained.classes, found.channels, found.identity, trained.temperature)
    weights = {name: value.contiguous() for name, value in trained.network.state_dict().items()}
    write_file(path, save(weights, metadata={"format": FORMAT, "facts": json.dumps(asdict(facts))}))


def load_circular(path: Path) -> tuple[CircularNetwork, CircularFacts]:
    """Read a network written by `save_circular`; nothing in the file is executed.

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
        facts = CircularFacts(
            tuple(found["classes"]), tuple(found["channels"]), str(found["identity"]), float(found["temperature"])
        )
        network = CircularNetwork(ROWS * len(facts.channels), len(facts.classes))
        network.load_state_dict(load_file(path))
    except (KeyError, TypeError, ValueError, RuntimeError, SafetensorError) as error:
        text = str(error).splitlines()[0]
        raise UsageError(f"{path}: received facts or weights of another schema ({text}); train again") from error
    check_finite(path, network, facts.temperature)
    network.eval()
    return network, facts
