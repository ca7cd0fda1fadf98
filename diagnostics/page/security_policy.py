"""What a page may do, as its first element says: its own scripts and nothing else, no network.

A text of a stranger's set or recording that came into the page as markup could then still run nothing and send nothing.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence


def security_policy(scripts: Sequence[str]) -> str:
    """Return a page's content security policy.

    Parameters
    ----------
    scripts : sequence of str
        What stands between the tags of every script that runs, to the letter. Attributes such as onclick never run.
    """
    hashes = " ".join(map(script_hash, scripts))
    rules = [
        "default-src 'none'",
        f"script-src {hashes}",
        "style-src 'unsafe-inline'",  # style attributes have no hash; a style loads nothing under these rules
        "img-src data:",
        "base-uri 'none'",
        "form-action 'none'",
    ]
    return "; ".join(rules)


def script_hash(script: str) -> str:
    """Return by what a policy allows a script that stands in a page."""
    # what a browser hashes: line ends of the document are read as \n
    content = script.replace("\r\n", "\n").replace("\r", "\n")
    return f"'sha256-{base64.b64encode(hashlib.sha256(content.encode()).digest()).decode()}'"
