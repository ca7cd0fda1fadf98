"""The command line as a whole: help, exit codes, and messages in place of tracebacks."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from siggen.cli.app import COMMANDS, app, main
from siggen.cli.inspect import View

SLOW = ("numpy", "scipy", "numba", "pyarrow", "pydantic", "yaml", "matplotlib")


def run_main(monkeypatch, error: BaseException) -> int:
    """Run `main` with an app that raises an error; return the exit code."""

    def failing(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(typer.Typer, "__call__", failing)
    with pytest.raises(SystemExit) as caught:
        main()
    return int(caught.value.code or 0)


def siggen_command(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    code = "from siggen.cli.app import main; main()"
    return subprocess.run(
        [sys.executable, "-c", code, *arguments],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, **environment},
        cwd=Path(__file__).resolve().parents[2],
    )


NAMES = [command.__name__.replace("_", "-") for command in COMMANDS]


@pytest.mark.parametrize("name", NAMES)
def test_every_command_shows_an_example(name):
    for flag in ("--help", "-h"):
        result = CliRunner().invoke(app, [*name.split(), flag])
        assert result.exit_code == 0
        assert "Example" in result.output
        assert f"siggen {name}" in result.output


def test_seven_commands_have_few_options_and_json_wherever_something_is_printed():
    options = {name: set(re.findall(r"--[a-z][a-z-]*", usage(name))) - {"--help"} for name in NAMES}
    assert len(options) == 7
    assert sum(len(own) for own in options.values()) <= 48
    assert [name for name, own in options.items() if not {"--json", "--log-json"} & own] == []


def usage(name: str) -> str:
    """Return the names of the options of a command, not what their sentences mention."""
    command = typer.main.get_command(app).commands[name]
    return " ".join(option for parameter in command.params for option in parameter.opts)


def test_the_completion_script_is_printed_and_an_option_completed():
    command = str(Path(sys.executable).with_name("siggen"))
    # What `--show-completion` prints follows from the shell that it is called from; this asks for one by name.
    asked = {"_SIGGEN_COMPLETE": "source_bash"}
    script = subprocess.run([command], capture_output=True, text=True, check=True, env={**os.environ, **asked}).stdout
    assert "complete -o default -F _siggen_completion siggen" in script
    asked = {"_SIGGEN_COMPLETE": "complete_bash", "COMP_WORDS": "siggen generate --exe", "COMP_CWORD": "2"}
    found = subprocess.run([command], capture_output=True, text=True, check=True, env={**os.environ, **asked})
    assert found.stdout.split() == ["--executor"]


def test_help_of_inspect_names_every_view():
    output = CliRunner().invoke(app, ["inspect", "--help"]).output
    assert all(view.value in output for view in View)


def test_no_command_shows_the_help_and_is_a_slip():
    result = CliRunner().invoke(app, [])
    assert result.exit_code == 2
    assert all(name in result.output for name in NAMES)


def test_the_version_is_printed():
    result = CliRunner().invoke(app, ["--version"])
    assert result.exit_code == 0
    assert result.output.startswith("siggen ")


def test_help_loads_nothing_slow():
    code = f"import sys, siggen.cli.app; print([name for name in {SLOW!r} if name in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def test_an_interruption_has_its_own_exit_code(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["siggen", "verify", "runs/quickstart"])
    assert run_main(monkeypatch, KeyboardInterrupt()) == 130
    assert capsys.readouterr().err == (
        "siggen: interrupted; the set is unchanged; the same command checks it from the beginning\n"
    )


def test_too_little_memory_is_said_with_how_to_go_on(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["siggen", "generate", "quickstart"])
    assert run_main(monkeypatch, MemoryError()) == 1
    assert capsys.readouterr().err == (
        "siggen: not enough memory; finished shards stay, and the same command goes on from there\n"
    )


def test_a_wrong_configuration_is_reported_on_stderr_without_a_traceback():
    result = siggen_command("plan", "tests/configs/linear_pits.yaml", "--set", "gears.modul_mm=3", "--set", "seed=x")
    assert result.returncode == 2
    assert result.stdout == ""
    assert "Traceback" not in result.stderr
    assert "tests/configs/linear_pits.yaml with overrides: 2 problems" in result.stderr
    assert "gears.modul_mm: received 3; there is no such key here; did you mean 'module_mm'?" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("plan", "siggen plan: CONFIG is missing: YAML file of the set, or a preset such as quickstart"),
        ("plan a b", "siggen plan: received more than it takes: b"),
        ("plan a --sets x", "siggen plan: --sets: no such option; did you mean --set?"),
        ("verify a --sample -1", "siggen verify: --sample: received -1; allowed: a whole number from 0 on"),
        ("verify a --sample two", "siggen verify: --sample: received two; allowed: a whole number from 0 on"),
        (
            "generate a --out b --allowed-loss 3",
            "siggen generate: --allowed-loss: received 3; allowed: a number from 0 to",
        ),
        ("generate a --out", "siggen generate: --out: a value is missing"),
        ("generate a --out b --version=3", "siggen generate: --version: no such option"),
        ("show a --internals=3", "siggen show: --internals: received a value; it takes none"),
        ("inspect foo a", "siggen inspect: WHAT: received foo; allowed: tvms, parts, flank, pressure, errors,"),
        ("nonsense", "siggen: nonsense: no such command; allowed: init, plan, generate, verify,"),
    ],
)
def test_a_slip_is_one_line_that_says_what_came_what_is_allowed_and_where_to_read_on(
    monkeypatch, capsys, arguments, words
):
    monkeypatch.setattr(sys, "argv", ["siggen", *arguments.split()])
    with pytest.raises(SystemExit) as stop:
        main()
    said = capsys.readouterr().err
    assert stop.value.code == 2
    assert said.startswith(words)
    assert said.count("\n") == 1
    assert said.endswith(" -h` explains)\n")
