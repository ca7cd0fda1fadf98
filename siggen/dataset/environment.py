"""The machine and the versions that decide whether a record can be made again bit for bit."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path

from siggen.sources import CHARACTERS, installed_version, sources_digest

PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "pyarrow")
MAKES_RECORDS = (
    *(
        "arrays.py",
        "compiled.py",
        "names.py",
        "seeding.py",
        "uniform_spline.py",
        "lanes/**/*.py",
        "keys/**/*.py",
    ),
    *("noise/**/*.py", "sensors/**/*.py", "life/**/*.py", "config/**/*.py", "rig/**/*.py"),
    *("gears/**/*.py", "drivetrain/**/*.py", "damage/**/*.py", "mesh/**/*.py", "motion/**/*.py", "sensing/**/*.py"),
    *("gearbox/**/*.py", "columns/**/*.py", "record/**/*.py"),
    "dataset/simulated_rows.py",
)
"""Sources that can change a record of a configuration. What checks a configuration, writes files, distributes tasks or
draws pictures is none of them."""

MAKES_BITS = ("sources", "numpy", "scipy", "numba", "llvmlite", "python", "system", "libc", "cpu")
CHOOSES_INSTRUCTIONS = ("NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES", "OPENBLAS_CORETYPE", "NPY_DISABLE_CPU_FEATURES")
"""Variables with which a user asks for other instructions than those of the processor."""

VECTOR_EXTENSIONS = ("avx", "avx2", "fma", "avx512f", "avx512dq", "avx512vl", "asimd", "sve")
"""Extensions for which compilers and numpy choose other instructions, hence another rounding."""


def environment() -> dict[str, str]:
    """Return versions, sources, system, C library and CPU family, and the `fingerprint` of what can change a bit."""
    facts = {
        "siggen": installed_version(),
        **{package: installed_version(package) for package in PACKAGES},
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "libc": " ".join(platform.libc_ver()).strip() or "unknown",
        "cpu": _cpu(),
        "sources": sources_digest(MAKES_RECORDS),
    }
    makes_bits = json.dumps({name: facts[name] for name in MAKES_BITS}, sort_keys=True)
    return {**facts, "fingerprint": sha256(makes_bits.encode()).hexdigest()[:CHARACTERS]}


def fingerprint(made_in: Mapping[str, str]) -> str:
    """Return the fingerprint of an environment; empty if a stranger gave it none."""
    return made_in.get("fingerprint", "")


def version_text(made_in: Mapping[str, str]) -> str:
    """Return which siggen an environment had, and its fingerprint."""
    own = fingerprint(made_in)
    siggen = made_in.get("siggen", "of unknown version")[:40]
    return f"siggen {siggen} ({f'fingerprint {own[:CHARACTERS]}' if own else 'without fingerprint'})"


def _cpu() -> str:
    """Return vendor, family, model and vector extensions; not the frequency nor the number of cores."""
    try:
        lines = Path("/proc/cpuinfo").read_text().split("\n\n", 1)[0].splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    facts = {key.strip(): value.strip() for key, _, value in (line.partition(":") for line in lines)}
    flags = set((facts.get("flags") or facts.get("Features") or "").split())
    vendor = facts.get("vendor_id") or facts.get("CPU implementer") or platform.machine()
    family = facts.get("cpu family") or facts.get("CPU architecture") or "?"
    model = facts.get("model") or facts.get("CPU part") or "?"
    asked = (f"{name}={os.environ[name]}" for name in CHOOSES_INSTRUCTIONS if os.environ.get(name))
    return " ".join([vendor, "family", family, "model", model, *(f for f in VECTOR_EXTENSIONS if f in flags), *asked])
