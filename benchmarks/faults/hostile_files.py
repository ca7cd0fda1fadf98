"""Configuration files that attack whoever reads them, and what the command does with each: code, time, memory."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

PRESET = Path(__file__).resolve().parents[2] / "configs" / "quickstart.yaml"
MEASURED = """
import resource, sys
from siggen.cli.app import main
sys.argv = ["siggen", "plan", sys.argv[1]]
code = 0
try:
    main()
except SystemExit as stop:
    code = stop.code
used = resource.getrusage(resource.RUSAGE_SELF)
peak = next(int(line.split()[1]) * 1024 for line in open("/proc/self/status") if line.startswith("VmHWM:"))
print("MEASURED", code, used.ru_utime + used.ru_stime, peak)
"""


@dataclass(frozen=True, slots=True)
class Refusal:
    """What a command did: exit code, CPU time, peak of memory, first line of its message, whether it is in words."""

    exit_code: int
    seconds: float
    peak_bytes: int
    message: str
    in_words: bool


def hostile_texts() -> Mapping[str, str]:
    """Return texts by what is hostile about them."""
    preset = PRESET.read_text(encoding="utf-8")
    pairs = range(1, 60)
    return {
        "a billion laughs": "a0: &a0 [ha, ha]\n" + "".join(f"a{i}: &a{i} [*a{i - 1}, *a{i - 1}]\n" for i in pairs),
        "a billion merges": "a0: &a0 {x: 1}\n"
        + "".join(f"a{i}: &a{i} {{<<: [*a{i - 1}, *a{i - 1}]}}\n" for i in pairs),
        "60,000 brackets": "a: " + "[" * 60_000,
        "a list in itself": "a: &a [*a]\n",
        "a tag that would run code": "a: !!python/object/apply:os.system [id]\n",
        "20 MB of comments": "# nothing\n" * 2_000_000,
        "7,000 unknown keys": preset + "".join(f"k{i}: 1\n" for i in range(7_000)),
        "5,000 unknown keys of gears": preset.replace(
            "gears:\n", "gears:\n" + "".join(f"  k{i}: 1\n" for i in range(5_000))
        ),
        "1,500 wrong operating points": re.sub(
            r"operating_points:\n(?:[ -].*\n)+",
            "operating_points:\n" + "  - {speed_hz: -1, torque_nm: x}\n" * 1_500,
            preset,
        ),
        "10^390 repeats": preset + f"repeats: 1{'0' * 390}\n",
        "control characters": preset + "\x07\n",
    }


def hostile_files(folder: Path) -> dict[str, Path]:
    """Write the texts into a folder and return their files."""
    files = {}
    for number, (what, text) in enumerate(hostile_texts().items()):
        files[what] = folder / f"hostile_{number}.yaml"
        files[what].write_text(text, encoding="utf-8")
    return files


def refusal(file: Path) -> Refusal:
    """Return what `siggen plan` does with a file, in a process of its own."""
    command = [sys.executable, "-c", MEASURED, str(file)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    measured = [line.split() for line in done.stdout.splitlines() if line.startswith("MEASURED")]
    code, seconds, peak = measured[-1][1:] if measured else ("1", "nan", "0")
    lines = [line for line in done.stderr.splitlines() if line.strip()]
    told = next((line.strip() for line in lines[1:]), lines[0] if lines else "")
    return Refusal(
        int(code), float(seconds), int(peak), told, "Traceback" not in done.stderr and "received" in done.stderr
    )
