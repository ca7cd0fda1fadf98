"""Text of a page can be read in light and dark: a contrast of 4.5, as WCAG 2.2 asks of small text (1.4.3)."""

from __future__ import annotations

import re

import numpy as np
import pytest

from diagnostics.page.blocks import Page
from diagnostics.page.template import page_html

STYLE = page_html(Page("no blocks", []))
LIGHT, DARK = (
    dict(re.findall(r"--(\w+):#(\w+)", part))
    for part in re.findall(r":root(?::not\(.print\))?\{(.*?)\}", STYLE, re.DOTALL)
)


def colour(text: str) -> np.ndarray:
    full = "".join(2 * sign for sign in text) if len(text) == 3 else text
    return np.array([int(full[start : start + 2], 16) for start in (0, 2, 4)]) / 255.0


def luminance(srgb: np.ndarray) -> float:
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def contrast(text: np.ndarray, ground: np.ndarray) -> float:
    low, high = sorted((luminance(text), luminance(ground)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("names", [LIGHT, DARK], ids=["light", "dark"])
def test_text_stands_out_from_paper_bands_and_the_darkest_cell_of_a_heat_map(names: dict[str, str]) -> None:
    palette = {name: colour(value) for name, value in names.items()}
    for text in ("ink", "soft", "accent"):
        for ground in ("paper", "band", "warm"):
            assert contrast(palette[text], palette[ground]) >= 4.5, (text, ground)
    shades = re.findall(r"srgb,#(\w{6}) (\d+)%", STYLE)
    assert len(shades) == 11
    for blue, percent in shades:
        ground = palette["paper"] + (colour(blue) - palette["paper"]) * int(percent) / 100.0
        assert contrast(palette["ink"], ground) >= 4.5, percent
