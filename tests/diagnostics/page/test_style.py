"""Logarithmic axes are labelled with numbers that can be read, though figures parse no formulas."""

from __future__ import annotations

import pytest
from matplotlib.ticker import FuncFormatter

from diagnostics.page.style import new_figure, png_bytes, styled

pytestmark = pytest.mark.drawn


def test_labels_of_a_logarithmic_axis_are_plain_text_and_those_of_ones_own_stay() -> None:
    with styled():
        figure, axes = new_figure(1, 2, height_in=2.0)
        for axis in axes.ravel():
            axis.semilogy([0, 1], [2e-3, 30.0])
        axes[0, 1].yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g} g"))
        png_bytes(figure)
    shown = [label.get_text() for label in axes[0, 0].get_yticklabels()]
    assert {"10⁻²", "10⁻¹", "10⁰", "10¹"} <= set(shown)
    assert not any(mark in text for text in shown for mark in "$\\{")
    assert "0.1 g" in [label.get_text() for label in axes[0, 1].get_yticklabels()]


def test_an_axis_of_less_than_a_decade_is_labelled_between_powers() -> None:
    with styled():
        figure, axes = new_figure(height_in=2.0)
        axes[0, 0].semilogy([0, 1], [2.1e-3, 7.9e-3])
        png_bytes(figure)
    shown = {label.get_text() for label in axes[0, 0].get_yticklabels(minor=True)}
    assert "4×10⁻³" in shown
