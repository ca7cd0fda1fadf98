"""Order-resampled windows for training: streams of them, and windows by number; loaded when first used."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from diagnostics.loader.epoch_order import Shuffling
    from diagnostics.loader.streamed_windows import StreamedWindows
    from diagnostics.loader.window_dataset import ShardSampler, WindowDataset
    from diagnostics.loader.window_index import StreamSettings
    from diagnostics.loader.window_stream import WindowLoader, WindowStream

__all__ = [
    "ShardSampler", "Shuffling", "StreamSettings", "StreamedWindows", "WindowDataset", "WindowLoader", "WindowStream",
]  # fmt: skip

_HOMES = {
    "ShardSampler": "window_dataset",
    "Shuffling": "epoch_order",
    "StreamSettings": "window_index",
    "StreamedWindows": "streamed_windows",
    "WindowDataset": "window_dataset",
    "WindowLoader": "window_stream",
    "WindowStream": "window_stream",
}


def __getattr__(name: str) -> Any:
    """Return a public name from the module that defines it."""
    if name not in _HOMES:
        raise AttributeError(f"diagnostics.loader has no {name!r}; it has {', '.join(__all__)}")
    return getattr(import_module(f"diagnostics.loader.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    """Return the public names, loaded or not, so that completion and `help` show them."""
    return sorted(__all__)
