"""A page reads well without a script, sorts with one, numbers what can be cited, and is the same every time."""

from __future__ import annotations

import re
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diagnostics.page.blocks import (
    PRINTED_ROWS,
    Block,
    Cell,
    FigureBlock,
    FigureGrid,
    Heading,
    Page,
    Paragraph,
    TableBlock,
    note_blocks,
)
from diagnostics.page.security_policy import security_policy
from diagnostics.page.style import (
    FAULT_COLOURS,
    WIDTH_IN,
    fault_colours,
    new_figure,
    png_bytes,
    state_colours,
    styled,
)
from diagnostics.page.template import page_html
from diagnostics.page.wording import minus

BROWSER = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), ""
)
ROWS = [
    [Cell("fm4_pinion"), Cell("0.50", "0.40 … 0.60", 0.5), Cell("< 0.001", value=1e-5)],
    [Cell("rms"), Cell("undefined", value=float("nan")), Cell("0.020", value=0.02)],
    [Cell("kurtosis"), Cell("-0.75", value=-0.75), Cell("1.000", value=1.0)],
    [Cell("na4_10"), Cell("10.00", value=10.0), Cell("0.500", value=0.5)],
    [Cell("na4_9"), Cell("undefined", value=float("nan")), Cell("–", value=float("nan"))],
]
HEAD = ("Feature", "AUC [-]", "p")


def written(*blocks: Block) -> str:
    return page_html(Page("x", blocks))


@pytest.mark.drawn
def test_figures_and_tables_are_numbered_by_kind_in_the_order_of_the_page() -> None:
    with styled():
        png = png_bytes(new_figure(height_in=1.0)[0])
    parts = [TableBlock(HEAD, ROWS, caption="First."), FigureBlock(png, "A curve."), TableBlock(HEAD, ROWS)]
    page = written(*parts, TableBlock(HEAD, ROWS, caption="Second."), FigureBlock(png, "Another."))
    found = re.findall(r"<b>((?:Figure|Table) \d\.)</b> (\w+)", page)
    assert found == [("Table 1.", "First"), ("Figure 1.", "A"), ("Table 2.", "Second"), ("Figure 2.", "Another")]


def test_a_table_without_its_script_has_plain_heads_and_row_names() -> None:
    text = written(TableBlock(HEAD, ROWS, sortable=True))
    assert "<button" not in text.split("<script>")[0]
    assert text.count('<th scope="col">') == 3
    assert text.count('<th scope="row">') == 5
    assert 'tabindex="0"' in text  # a box that scrolls is reached by keyboard


def test_numbers_have_a_true_minus_and_zero_has_no_sign() -> None:
    cells = {"-0.75": "\N{MINUS SIGN}0.75", "+0.00": "0.00", "-0.00": "0.00", "-0": "0", "-0.05": "\N{MINUS SIGN}0.05"}
    cells |= {
        "+0.10": "+0.10",
        "1e-09": "1e-09",
        "1-D network": "1-D network",
        "-30 … -8": "\N{MINUS SIGN}30 … \N{MINUS SIGN}8",
    }
    assert {text: minus(text) for text in cells} == cells


def test_code_and_long_names_are_set_and_nothing_else_is_taken_for_markup() -> None:
    assert "<p><code>report DIR</code> of a_<wbr>b &lt;x&gt;</p>" in written(Paragraph("`report DIR` of a_b <x>"))


def test_paper_gets_the_first_rows_of_a_long_table_and_says_so() -> None:
    rows = [[Cell(f"row {k}"), Cell(str(k))] for k in range(PRINTED_ROWS + 1)]
    assert f"the first {PRINTED_ROWS} of {PRINTED_ROWS + 1} rows" in written(TableBlock(("a", "b"), rows, tall=True))
    assert "On paper" not in written(TableBlock(("a", "b"), rows[1:], tall=True))
    assert "On paper" not in written(
        TableBlock(("a", "b"), rows, tall=True, text=True)
    )  # definitions are read, not looked up
    assert f"tr:nth-child(n+{PRINTED_ROWS + 1})" in written()


def test_notes_are_sentences() -> None:
    assert note_blocks(["no network", "Why?"]) == [Paragraph("No network.", "note"), Paragraph("Why?", "note")]


@pytest.mark.drawn
def test_a_picture_holds_a_palette_the_same_bytes_every_time_and_its_size() -> None:
    def drawn() -> bytes:
        with styled():
            figure, axes = new_figure(height_in=2.0)
            for colour in FAULT_COLOURS:
                axes[0, 0].plot(np.sin(np.arange(500.0)), color=colour)
            return png_bytes(figure)

    png = drawn()
    assert png == drawn()
    assert png[25] == 3  # colour type of the header: palette
    assert struct.unpack(">II", png[16:24]) == (round(WIDTH_IN * 200), 400)
    assert 'width="960" height="400"' in written(FigureBlock(png, "A caption."))


@pytest.mark.drawn
def test_colours_of_the_figure_survive_the_palette(tmp_path: Path) -> None:
    with styled():
        figure, axes = new_figure(height_in=2.0)
        for place, colour in enumerate(FAULT_COLOURS):
            axes[0, 0].axvspan(place, place + 1, color=colour)
        (tmp_path / "a.png").write_bytes(png_bytes(figure))
    colours = {colour[1] for colour in Image.open(tmp_path / "a.png").convert("RGB").getcolors(4096)}
    for wanted in FAULT_COLOURS:
        exact = [int(wanted[start : start + 2], 16) for start in (1, 3, 5)]
        # 8 of 255 is below what is seen side by side
        assert min(max(abs(a - b) for a, b in zip(exact, colour, strict=True)) for colour in colours) <= 8


@pytest.mark.parametrize("count", [1, 5, 8, 13])
def test_states_have_different_colours_that_darken_with_severity(count: int) -> None:
    colours = fault_colours(count)
    light = [sum(w * int(c[k : k + 2], 16) for w, k in ((0.299, 1), (0.587, 3), (0.114, 5))) for c in colours]
    assert len(set(colours)) == count
    assert light == sorted(light, reverse=True)
    assert state_colours(("h", *map(str, range(count))), {"h"})[str(count - 1)] == colours[-1]


def opened(page: str, tmp_path: Path, width: int = 1200) -> str:
    """Return the page after its scripts ran in a real browser."""
    (tmp_path / "page.html").write_text(page, encoding="utf-8")
    flags = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}"]
    command = [BROWSER, *flags, f"--window-size={width},900", "--dump-dom", (tmp_path / "page.html").as_uri()]
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=500).stdout


def with_script(page: str, script: str) -> str:
    """Add a script of the test to a page and to its policy; the page's own scripts stay under it."""
    own = security_policy([script]).split("script-src ")[1].split(";")[0]
    page = page.replace("script-src ", f"script-src {own} ", 1)
    return page.replace("</body>", f"<script>{script}</script></body>")


def sorted_names(clicks: str, tmp_path: Path) -> tuple[list[str], list[str]]:
    """Return the names of the rows and the states of the heads after clicks on heads."""
    page = written(TableBlock(HEAD, ROWS, sortable=True))
    clicked = f"var heads=document.querySelectorAll('thead button');[{clicks}].forEach(k=>heads[k].click())"
    dom = opened(with_script(page, clicked), tmp_path)
    names = re.findall(r'<th scope="row">(.*?)</th>', dom)
    return [name.replace("<wbr>", "") for name in names], re.findall(r'aria-sort="(\w+)"', dom)


@pytest.mark.skipif(not BROWSER, reason="no chromium or chrome on this machine")
@pytest.mark.drawn
def test_on_a_phone_wide_tables_scroll_in_their_own_box_and_the_page_does_not(tmp_path: Path) -> None:
    wide = [
        [Cell(f"energy_operator_teager_pinion_{k}__side_horizontal"), *[Cell("+0.50", "+0.40 … +0.60")] * 20]
        for k in (1, 2)
    ]
    head = ("Indicator, channel", *[f"AUC, through_{k:03d}" for k in range(20)])
    with styled():
        figure = FigureBlock(png_bytes(new_figure(height_in=1.0)[0]), "A curve of energy_operator_teager_pinion_h5_k3.")
    tables = [TableBlock(head, wide, caption="Wide.", sortable=True), TableBlock(HEAD, ROWS)]
    parts = [Heading("sideband_ratio_pinion_h5_k3__side_horizontal", 1), Paragraph("a" * 90), *tables]
    script = (
        "var root=document.documentElement,box=document.querySelector('.scroll');"
        "document.title=[root.scrollWidth<=window.innerWidth,box.scrollWidth>box.clientWidth,window.innerWidth]"
    )
    page = with_script(written(*parts, FigureGrid([figure])), script)
    found = re.search(r"<title>(.*?)</title>", opened(page, tmp_path, width=390))
    assert found is not None
    fits, scrolls, width = found.group(1).split(",")
    assert (fits, scrolls) == ("true", "true")
    assert int(width) <= 600  # narrow enough for the rules of a phone


@pytest.mark.skipif(not BROWSER, reason="no chromium or chrome on this machine")
@pytest.mark.parametrize(
    ("clicks", "names", "heads"),
    [
        # numbers begin with the largest; what is undefined stays last both ways, in the order it had
        ("1", ["na4_10", "fm4_pinion", "kurtosis", "rms", "na4_9"], ["none", "descending", "none"]),
        ("1,1", ["kurtosis", "fm4_pinion", "na4_10", "rms", "na4_9"], ["none", "ascending", "none"]),
        ("2,2", ["fm4_pinion", "rms", "na4_10", "kurtosis", "na4_9"], ["none", "none", "ascending"]),
        ("1,0", ["fm4_pinion", "kurtosis", "na4_9", "na4_10", "rms"], ["ascending", "none", "none"]),
        ("0,0", ["rms", "na4_10", "na4_9", "kurtosis", "fm4_pinion"], ["descending", "none", "none"]),
    ],
)
def test_a_click_on_a_head_sorts(clicks: str, names: list[str], heads: list[str], tmp_path: Path) -> None:
    assert sorted_names(clicks, tmp_path) == (names, heads)
