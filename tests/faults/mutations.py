"""What comes of something mutated: taken, refused in words, or what must not happen, a traceback or a hang."""

from __future__ import annotations

import signal
import sys
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from random import Random

from benchmarks.row import Row, duration_text
from siggen.errors import EXIT_MISMATCH, EXIT_USAGE, SiggenError

SAID_EVERY = 100
LIMIT_S = 120.0


@dataclass(frozen=True, slots=True)
class Case:
    """Something mutated: its text or name, and what came of it: 'accepted', 'refused', 'traceback' or 'hang'."""

    text: str
    outcome: str
    message: str
    seconds: float


def outcomes_row(what: str, cases: Iterable[Case], count: int, accepted: str, clock: str) -> Row:
    """Return the row of `count` cases; says on the way how many are done, and everything about one that went wrong."""
    outcomes: Counter[str] = Counter()
    longest_s = 0.0
    for number, case in enumerate(cases, start=1):
        outcomes[case.outcome] += 1
        longest_s = max(longest_s, case.seconds)
        if case.outcome in {"traceback", "hang"}:
            print(f"{case.outcome}: {case.text}\n{case.message}", file=sys.stderr, flush=True)
        if number % SAID_EVERY == 0:
            print(f"{what}: {number} done, {dict(outcomes)}", file=sys.stderr, flush=True)
    longest = f"longest {duration_text(longest_s)} of {clock}"
    measured = f"{outcomes['refused']} refused in words, {outcomes['accepted']} {accepted}, {longest}"
    others = f"tracebacks: {outcomes['traceback']}, hangs: {outcomes['hang']}"
    return Row(what, measured, others, None, "no other", outcomes["accepted"] + outcomes["refused"] == count)


def judged(text: str, work: Callable[[], object], cpu_limit_s: float | None = None) -> Case:
    """Return what came of some work, which has `LIMIT_S`, or so much CPU time, which others do not stretch."""
    timer, alarm = (signal.ITIMER_REAL, signal.SIGALRM) if cpu_limit_s is None else (signal.ITIMER_PROF, signal.SIGPROF)
    started_s = time.process_time()
    outcome, message = "accepted", ""
    before = signal.signal(alarm, _too_long)
    signal.setitimer(timer, cpu_limit_s or LIMIT_S)
    try:
        work()
    except SiggenError as error:
        outcome, message = "refused" if error.exit_code in {EXIT_USAGE, EXIT_MISMATCH} else "traceback", str(error)
    except _TooLong:
        outcome, message = "hang", traceback.format_exc()
    except Exception:
        outcome, message = "traceback", traceback.format_exc()
    finally:
        signal.setitimer(timer, 0.0)
        signal.signal(alarm, before)
    return Case(text, outcome, message, time.process_time() - started_s)


class _TooLong(BaseException):
    """Not an Exception, so that nothing on the way swallows it."""


def _too_long(_number: int, _frame: object) -> None:
    raise _TooLong


def mutated_bytes(content: bytes, chance: Random) -> bytes:
    """Return a file with one to eight changes, most of them where a format keeps its structure: at its ends."""
    changed = bytearray(content)
    for _ in range(chance.randint(1, 8)):
        if not changed:
            return b""
        near = chance.choice((64, 512, len(changed)))
        place = min(chance.randrange(near), len(changed) - 1)
        place = place if chance.random() < 0.6 else len(changed) - 1 - place
        _change(changed, place, chance)
    return bytes(changed)


def _change(content: bytearray, place: int, chance: Random) -> None:
    kind = chance.randrange(6)
    if kind == 0:
        content[place] ^= 1 << chance.randrange(8)
    elif kind == 1:
        content[place] = chance.choice((0, 1, 0x7F, 0x80, 0xFF))
    elif kind == 2:
        huge = chance.choice((0x7FFFFFFF, 0xFFFFFFFF, 0x80000000, 1 << 20, 0)).to_bytes(4, "little")
        content[place : place + 4] = huge
    elif kind == 3:
        del content[place : place + chance.choice((1, 4, 1000, len(content)))]
    elif kind == 4:
        content[place:place] = chance.randbytes(chance.choice((1, 4, 300)))
    else:
        content[place : place + 16] = content[:16]
