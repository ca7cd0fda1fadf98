"""The network on disk: safetensors with everything needed to use it."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import load_file, save

from diagnostics.loader.windows import WindowSettings
from diagnostics.training.cnn import TrainedNetwork, WideKernelNetwork
from siggen.errors import UsageError
from siggen.file_writing import write_file

FORMAT = "siggen-diagnostics wide-kernel network 1"


@dataclass(frozen=True, slots=True)
class NetworkFile:
    """What a file of a network says about it.

    Attributes
    ----------
    classes, channels : tuple of str
        States in the order of the outputs, channels in the order of the inputs.
    windows : WindowSettings
        Revolutions per window and samples per revolution.
    mean_m_s2, scale_m_s2 : tuple of float
        Normalisation per channel, already inside the network.
    identity : str
        Identity of the set it was trained on.
    temperature : float
        Applied to the mean probabilities of a record's windows, see `diagnostics.statistics.calibration`; not in the
        network.
    """

    classes: tuple[str, ...]
    channels: tuple[str, ...]
    windows: WindowSettings
    mean_m_s2: tuple[float, ...]
    scale_m_s2: tuple[float, ...]
    identity: str
    temperature: float = 1.0


def describe_network(
    trained: TrainedNetwork, channels: tuple[str, ...], windows: WindowSettings, identity: str
) -> NetworkFile:
    """Return what the file of a trained network says about it."""
    network = trained.network
    mean, scale = (tuple(float(x) for x in buffer.flatten()) for buffer in (network.mean, network.scale))
    return NetworkFile(trained.classes, channels, windows, mean, scale, identity, trained.temperature)


def save_network(network: WideKernelNetwork, facts: NetworkFile, path: Path) -> None:
    """Write weights and facts as safetensors; the facts are JSON under the metadata key `facts`."""
    weights = {name: value.contiguous() for name, value in network.state_dict().items()}
    write_file(path, save(weights, metadata={"format": FORMAT, "facts": json.dumps(asdict(facts))}))


def load_network(path: Path) -> tuple[WideKernelNetwork, NetworkFile]:
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
        facts = _facts(json.loads(metadata["facts"]))
        network = WideKernelNetwork(len(facts.channels), len(facts.classes), facts.windows.samples_per_tooth)
        network.load_state_dict(load_file(path))
    except (KeyError, TypeError, ValueError, RuntimeError, SafetensorError) as error:
        text = str(error).splitlines()[0]
        raise UsageError(f"{path}: received facts or weights of another schema ({text}); train again") from error
    check_finite(path, network, facts.temperature)
    network.eval()
    return network, facts


def check_finite(path: Path, network: torch.nn.Module, temperature: float) -> None:
    """Check the values of a network that was read.

    Raises
    ------
    UsageError
        If a weight is not finite, or the temperature is not finite and above 0.
    """
    infinite = [name for name, value in network.state_dict().items() if not bool(torch.isfinite(value).all())]
    if infinite:
        raise UsageError(f"{path}: received {infinite[0]} that is not finite; the file is damaged: train again")
    if not (math.isfinite(temperature) and temperature > 0.0):
        raise UsageError(f"{path}: received temperature {temperature}; allowed: finite and above 0; train again")


def _facts(found: dict[str, object]) -> NetworkFile:
    tuples = {name: tuple(value) for name, value in found.items() if isinstance(value, list)}
    windows = WindowSettings(**found["windows"])  # type: ignore[arg-type]
    temperature = float(str(found.get("temperature", 1.0)))
    return NetworkFile(windows=windows, identity=str(found["identity"]), temperature=temperature, **tuples)
