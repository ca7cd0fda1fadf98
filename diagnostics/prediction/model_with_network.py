"""What the process that tries models does with one that holds a network: it loads torch before it has limits."""

from __future__ import annotations

from diagnostics.prediction import released_model
from diagnostics.prediction.released_model import try_model

__all__ = ("try_model",)

LOADED_ONCE = (*released_model.LOADED_ONCE, "diagnostics.training.cnn")
"""As far as it is installed."""
