"""What a block prints beside what its page says: the same words, numbers within the digits that the page shows."""

from __future__ import annotations

import re
from decimal import Decimal

NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.]*\w)")
ANY_NUMBER = r"(-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)"
ELIDED = "..."


def difference(said: str, printed: str, *, same_numbers: bool = True) -> str | None:
    """Return None, or what is not as the page says; `...` of the page stands for any text, white space for any."""
    match = re.fullmatch(_pattern(said.strip()), printed.strip(), re.DOTALL)
    if match is None:
        return f"the page says\n{said}\nprinted was\n{printed}"
    if not same_numbers:
        return None
    wrong = [f"{b} for {a}" for a, b in zip(_numbers(said), match.groups(), strict=True) if not _agree(a, b)]
    return f"printed was {', '.join(wrong)}" if wrong else None


def _pattern(said: str) -> str:
    return ".*?".join(_words(part) for part in said.split(ELIDED))


def _words(part: str) -> str:
    texts = (
        re.sub(r"\s+", r"\\s+", re.escape(text).replace("\\\n", "\n").replace("\\ ", " ")) for text in _between(part)
    )
    return ANY_NUMBER.join(texts)


def _between(part: str) -> list[str]:
    return NUMBER.split(part)


def _numbers(said: str) -> list[str]:
    return [number for part in said.strip().split(ELIDED) for number in NUMBER.findall(part)]


def _agree(said: str, printed: str) -> bool:
    """Whole numbers are equal; others lie within one of the last digit that the page shows."""
    last = Decimal(said).as_tuple().exponent
    assert isinstance(last, int)
    bound = Decimal(0) if re.fullmatch(r"-?\d+", said) else Decimal(10) ** last
    return abs(Decimal(said) - Decimal(printed)) <= bound
