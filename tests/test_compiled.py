"""Compiled functions are cached where that can be done, where nobody else can write, and never from older sources."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from siggen.compiled import WITH_COMPILED_CODE, entry, njit, private_folder

WITHOUT_A_FOLDER = """
import numba.core.caching as caching
from pathlib import Path
import sys
import siggen.compiled

def refused(cls, py_func, py_file):
    return None

for name in ("InTreeCacheLocator", "InTreeCacheLocatorFsAgnostic", "UserWideCacheLocator"):
    for kind in (name, f"_{name}"):
        if hasattr(caching, kind):
            setattr(getattr(caching, kind), "from_function", classmethod(refused))
from siggen.sensing import tones
import numpy as np
signal = np.zeros(300)
tones._add_line(signal, 0.1, 2.0, 0.5)
assert np.allclose(signal, 2.0 * np.cos(0.1 * np.arange(300) + 0.5))
print(len(list(Path(sys.argv[1]).rglob("*.nbi"))))
"""


def test_without_a_folder_for_the_cache_functions_are_cached_among_temporary_files(tmp_path: Path) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_A_FOLDER, str(tmp_path)], env={**environment, "TMPDIR": str(tmp_path)},
        check=False, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) == 1


@pytest.mark.skipif(os.name == "nt", reason="permissions of POSIX")
def test_a_folder_that_others_can_write_to_or_that_leads_elsewhere_is_not_taken(tmp_path: Path) -> None:
    folder = private_folder(tmp_path)
    assert folder is not None
    assert private_folder(tmp_path) == folder
    folder.chmod(0o777)
    assert private_folder(tmp_path) is None
    folder.rmdir()
    (tmp_path / "elsewhere").mkdir(mode=0o700)
    folder.symlink_to(tmp_path / "elsewhere")
    assert private_folder(tmp_path) is None
    assert private_folder(tmp_path / "nowhere") is None


def test_python_is_refused_by_a_function_for_compiled_code_alone() -> None:
    def plus_one(x: float) -> float:
        return x + 1.0

    inner = njit(cache=False)(plus_one)

    @entry(cache=False)
    def outer(x: float) -> float:
        return 2.0 * inner(x)

    assert outer(3.0) == 8.0
    with pytest.raises(TypeError, match=r"plus_one is compiled for compiled code alone; decorate it with @entry"):
        inner(3.0)


CALLED = "from siggen.compiled import njit\n\n@njit(cache=True)\ndef called(x):\n    return x + {added}\n"
CALLER = """
from siggen.compiled import entry, is_cached
from siggen.motion.called import called

@entry(cache=True)
def calling(x):
    return 2.0 * called(x)

print(is_cached(calling), calling(1.0))
"""


def test_a_change_in_a_called_file_compiles_its_callers_again(tmp_path: Path) -> None:
    package = tmp_path / "siggen"
    (package / "motion").mkdir(parents=True)
    for empty in (package / "__init__.py", package / "motion" / "__init__.py"):
        empty.touch()
    for file in ("compiled.py", "errors.py", "sources.py"):
        (package / file).write_bytes(Path("siggen", file).read_bytes())
    (tmp_path / "caller.py").write_text(CALLER, encoding="utf-8")

    def said(added: float) -> str:
        (package / "motion" / "called.py").write_text(CALLED.format(added=added), encoding="utf-8")
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": str(tmp_path)}
        command = [sys.executable, "-c", "import caller"]
        done = subprocess.run(command, env=environment, cwd=tmp_path, check=True, capture_output=True, text=True)
        return done.stdout.strip()

    assert [said(1.0), said(1.0), said(100.0)] == ["False 4.0", "True 4.0", "False 202.0"]


def test_the_sources_of_the_cache_hold_every_file_that_compiles() -> None:
    package = Path("siggen")
    compiling = {path for path in package.rglob("*.py") if re.search("@(njit|entry)", path.read_text(encoding="utf-8"))}
    assert compiling <= {path for pattern in WITH_COMPILED_CODE for path in package.glob(pattern)}
