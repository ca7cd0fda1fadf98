"""Configuration files that attack whoever reads them, and what the command does with each: code, time, memory."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from benchmarks.row import Row, duration_text
from siggen.keys.yaml_source import LARGEST_BYTES

PRESET = Path(__file__).resolve().parents[2] / "configs" / "quickstart.yaml"
COMMAND_S = 2.0
COMMAND_BYTES = 500e6
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


def rows(*, quick: bool) -> Iterator[Row]:  # each is tried once in any case
    """Yield a row per file: exit code, CPU time with the start, peak of memory."""
    with tempfile.TemporaryDirectory() as folder:
        yield from (_row(what, file) for what, file in hostile_files(Path(folder)).items())


def _row(what: str, file: Path) -> Row:
    found = refusal(file)
    measured = f"exit code {found.exit_code}, {duration_text(found.seconds)} of CPU, {found.peak_bytes / 1e6:.0f} MB"
    met = found.exit_code == 2 and found.seconds <= COMMAND_S and found.peak_bytes <= COMMAND_BYTES and found.in_words
    return Row(f"siggen plan, {what}", measured, found.message[:60], None, "2, <= 2 s, <= 500 MB", met)


def hostile_texts() -> Mapping[str, str]:
    """Return texts by what is hostile about them."""
    preset = PRESET.read_text(encoding="utf-8")
    pairs = range(1, 60)
    return {
        **_large_texts(preset),
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


def _large_texts(preset: str) -> Mapping[str, str]:
    """Return texts of up to 4 MiB, the most that is read, and of as many values as are counted before it is refused."""
    points = re.sub(r"operating_points:\n(?:[ -].*\n)+", "", preset)
    return {
        "4 MiB of list entries": "a:\n" + "- 1\n" * (LARGEST_BYTES // 4 - 10),
        "4 MiB of unknown keys": preset + "".join(f"k{i:06d}: 1\n" for i in range(LARGEST_BYTES // 11 - 2_000)),
        "4 MiB of a text of many lines": "a: x\n" + "  y\n" * (LARGEST_BYTES // 4 - 10),
        "4 MiB of anchors": "a:\n" + "".join(f"- &a{i:06d} x\n" for i in range(LARGEST_BYTES // 13 - 10)),
        "a name of 4 MiB": preset.replace("name: ", "name: " + "x" * (LARGEST_BYTES - 2 * len(preset.encode())), 1),
        "29,900 numbers as operating points": f"{points}operating_points: [{'1.5,' * 29_900}1]\n",
        "29,900 numbers as a module": preset.replace("module_mm: 3.0", f"module_mm: [{'1.5,' * 29_900}1]"),
        "3,600 wrong operating points": f"{points}operating_points:\n" + "  - {speed_hz: -1, torque_nm: x}\n" * 3_600,
        "6,000 wrong states": re.sub(r"states:\n(?:[ -].*\n)+", "", preset) + "states:\n" + "  - {a: 1}\n" * 6_000,
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
