"""Blocks are read, run and judged as the comments above them say."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.pages.blocks import blocks_of, given
from tests.pages.printed import difference
from tests.pages.running import failing, reader_environment

PAGE = """# Page
<!-- given: runs/quickstart, publication.yaml -->

```yaml title="a.yaml"
key: 1
```

<!-- given: recordings 18/47 -->
<!-- slow -->
<!-- smaller: 2 for 24 -->
```console
echo 24
```

gives

```output
24
```
"""


def test_a_page_is_read_with_its_marks() -> None:
    file, command = blocks_of(PAGE)
    assert (file.title, file.text, file.line) == ("a.yaml", "key: 1\n", 4)
    assert (command.is_slow, command.source, command.prints) == (True, "echo 2\n", "24\n")
    assert given(PAGE, slow=False) == ["runs/quickstart", "publication.yaml"]
    assert given(PAGE, slow=True) == ["runs/quickstart", "publication.yaml", "recordings 18/47"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("```sh\nls\n```\n", "a block of 'sh'"),
        ("<!-- slowly -->\n```console\nls\n```\n", "unknown mark"),
        ("```console slow\nls\n```\n", "a block of 'console slow'"),
    ],
)
def test_an_unknown_language_or_mark_is_refused(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        blocks_of(text)


@pytest.mark.parametrize(
    ("block", "wrong"),
    [
        ("```console\necho 0.7 s\n```\n<!-- other numbers -->\n```output\n0.5 s\n```\n", ""),
        ("```console\necho 0.7 m\n```\n<!-- other numbers -->\n```output\n0.5 s\n```\n", "the page says"),
        ("```console\ncat a.yaml | grep key\n```\n```output\nkey: 1\n```\n", ""),
        ("```console\nfalse | cat\necho on\n```\n", "exit code 1"),
        ("<!-- exit 4 -->\n```console\nexit 4\n```\n", ""),
        ("<!-- exit 4 -->\n```console\nexit 0\n```\n", "exit code 0"),
        ("```python\nraise KeyError('gone')\n```\n", "KeyError: 'gone'"),
        ("```console\necho 0.52 s\n```\n```output\n0.5 s\n```\n", ""),
        ("```console\necho 0.72 s\n```\n```output\n0.5 s\n```\n", "printed was 0.72 for 0.5"),
    ],
)
def test_a_block_that_fails_or_prints_something_else_is_found(block: str, wrong: str, tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text("key: 1\n")
    found = failing(blocks_of(block), tmp_path, reader_environment())
    assert wrong in found
    assert bool(wrong) == bool(found)


@pytest.mark.parametrize(
    ("said", "printed", "agree"),
    [
        ("rms 1.23e-05 m", "rms   1.2311e-05 m", True),
        ("rms 1.23e-05 m", "rms 1.25e-05 m", False),
        ("16 records in ... s", "16 records in 31.7 s", True),
        ("16 records", "17 records", False),
        ("a 1.5\n...\nz -2", "a 1.49\nb\nc\nz -2", True),
        ("a 1.5\n...\nz -2", "a 1.49\nb\nc\nz 2", False),
        ("train-00000.parquet", "train-00001.parquet", False),
    ],
)
def test_numbers_agree_within_the_digits_of_the_page(said: str, printed: str, agree: bool) -> None:
    assert (difference(said, printed) is None) == agree
