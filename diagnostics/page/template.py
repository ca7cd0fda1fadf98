"""A page as HTML: templates over its payload. All text is escaped; nothing is loaded from elsewhere."""

from __future__ import annotations

import base64
import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from diagnostics.base.extras import require_packages
from diagnostics.page.blocks import PRINTED_ROWS, Page
from diagnostics.page.live import script_json
from diagnostics.page.security_policy import security_policy
from diagnostics.page.wording import minus
from siggen.file_writing import write_file
from siggen.printable import printable

if TYPE_CHECKING:
    from jinja2 import Environment

TEMPLATES = Path(__file__).with_name("templates")


def write_page(path: Path, page: Page) -> None:
    """Write a page as one self-contained file.

    Raises
    ------
    UsageError
        If Jinja2 is missing.
    """
    write_file(path, page_html(page))


def page_html(page: Page) -> str:
    """Return the page as HTML, its figures and tables numbered."""
    script = (TEMPLATES / "page.js").read_text(encoding="utf-8")
    scripts = [script, *([page.live.script] if page.live.script else [])]
    template = environment().get_template("page.html")
    text = template.render(page=page, scripts=scripts, policy=security_policy(scripts), printed_rows=PRINTED_ROWS)
    return f"{text.lstrip()}\n"


@cache
def environment() -> Environment:
    """Return where templates come from and what they may call.

    Raises
    ------
    UsageError
        If Jinja2 is missing.
    """
    require_packages("a page", "jinja2")
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup, escape

    def shown(value: Any) -> Any:
        """Return what stands on the page: of strangers' texts all that is no visible sign is written out."""
        return value if isinstance(value, Markup) else printable(value, lines=True)

    def inline(text: str) -> Markup:
        """Return text with `code` between backticks, long names broken between their parts."""
        escaped = re.sub(r"`([^`]+)`", r"<code>\1</code>", str(escape(printable(text, lines=True))))
        return Markup(re.sub(r"(?<=\w)_(?=[^\W_])", "_<wbr>", escaped))

    def bold(text: Markup) -> Markup:
        """Return text with what stands between `**` in bold."""
        return Markup(re.sub(r"\*\*(.+?)\*\*", r"<b>\1</b>", str(text)))

    jinja = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        finalize=shown,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    jinja.filters |= {
        "inline": inline,
        "bold": bold,
        "minus": minus,
        "base64": lambda png: base64.b64encode(png).decode("ascii"),
        "script_json": lambda value: Markup(script_json(value)),
    }
    return jinja
