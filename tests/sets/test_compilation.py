"""Whoever waits for the first record on a machine is told why, and workers do not compile the same side by side."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
from numba.core.dispatcher import Dispatcher

import siggen
import siggen.sets.set_run
from siggen.damage import whole_loss
from siggen.gearbox.design import SetDesign
from siggen.motion import exponential_step
from siggen.record import compilation
from siggen.record.compilation import is_compiled, run_part
from siggen.sets import drawn
from siggen.sets.compilation import compilation_text
from siggen.sets.drawn import compilation_parts, simulated, to_compile

HEALTHY = ["specimens=1", "duration_s=0.05", "states={healthy: {}}"]


@pytest.fixture(scope="module")
def short() -> SetDesign:
    return siggen.load_config("configs/quickstart.yaml", ["specimens=1", "duration_s=0.05"])


def test_the_parts_compile_all_that_a_record_needs(short: SetDesign, monkeypatch: pytest.MonkeyPatch) -> None:
    for part in compilation_parts(short):
        run_part(part)
    later = []
    known = Dispatcher._compile_for_args

    def noted(dispatcher: Dispatcher, *arguments: object, **named: object) -> object:
        later.append(dispatcher.py_func.__qualname__)
        return known(dispatcher, *arguments, **named)

    monkeypatch.setattr(Dispatcher, "_compile_for_args", noted)
    list(simulated(short, range(short.records_per_specimen)))
    assert later == []


def test_a_configuration_is_checked_without_what_looks_for_lost_contacts(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*arguments: object) -> None:
        raise AssertionError("would be compiled before anything is told")

    monkeypatch.setattr(whole_loss, "section_kinks", refused)
    siggen.load_config("configs/quickstart.yaml")


def test_an_empty_cache_is_told_and_a_filled_one_is_not(short: SetDesign, monkeypatch: pytest.MonkeyPatch) -> None:
    run_part(compilation_parts(short)[1])
    assert is_compiled(short.method)
    assert (compilation_text(short.method, 2), to_compile(short)) == ("", ())
    older = SimpleNamespace(_cache=SimpleNamespace(_cache_file=SimpleNamespace(_load_index=dict)))
    monkeypatch.setattr(exponential_step, "advance", older)
    assert "compiling the simulation, the first time only: about 30 s" in compilation_text(short.method, 2)
    assert [part.name for part in to_compile(short)] == [compilation.TEETH, compilation.MOTION]


def test_a_run_compiles_before_its_first_record(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    called: list[type] = []

    def noted(workers, function, tasks, *_):
        for position, task in enumerate(tasks):
            called.append(type(task))
            yield position, function(task)

    monkeypatch.setattr(drawn, "is_compiled", lambda method: False)
    monkeypatch.setattr(siggen.sets.set_run, "results", noted)
    siggen.generate(siggen.load_config("quickstart", HEALTHY), tmp_path / "set", workers=1)
    assert [kind.__name__ for kind in called] == ["CompilationPart", "CompilationPart", "ShardPlan"]
