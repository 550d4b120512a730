"""The dispatcher: help, names, exit codes, and failures as one sentence."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from hiding import environment_without

from pneumo_ros import __version__
from pneumo_ros.command import main
from pneumo_ros.command.verb import effects
from pneumo_ros.errors import DataError, NumericalError, PneumoError


def pneumo(*arguments: str, **options: object) -> "subprocess.CompletedProcess[str]":
    """Run the command as a user does, in a process of its own."""
    return subprocess.run([sys.executable, "-m", "pneumo_ros", *arguments], capture_output=True, text=True, **options)


@pytest.mark.parametrize("arguments", [(), ("--help",), ("-h",)])
def test_help_lists_every_verb_with_one_line(arguments: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    assert main.main(arguments) == 0
    lines = capsys.readouterr().out.splitlines()
    for verb in main.VERBS:
        (line,) = [line for line in lines if line.split()[:1] == [verb]]
        assert len(line.split()) > 3, f"{verb} does not say what it does"


def test_every_verb_module_is_listed() -> None:
    folder = Path(main.__file__).parent / "verb"
    has_verb = {path.stem for path in folder.glob("*.py") if "def add_arguments(" in path.read_text(encoding="utf-8")}
    assert has_verb == set(main.VERBS)


@pytest.mark.parametrize("verb", main.VERBS)
def test_every_verb_explains_itself(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main.main([verb, "--help"])
    assert end.value.code == 0
    text = capsys.readouterr().out
    assert f"usage: pneumo {verb}" in text
    assert "--json" in text
    assert "--quiet" in text


def test_what_the_system_refuses_is_one_sentence(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(*_: object) -> int:
        raise PermissionError(13, "Permission denied", "runs")

    monkeypatch.setattr(effects, "run", refuse)
    assert main.main(["effects"]) == DataError.exit_code
    assert capsys.readouterr().err == "pneumo: error: runs: Permission denied\n"


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert main.main(["--version"]) == 0
    assert capsys.readouterr().out.split() == ["pneumo_ros", __version__]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["efects"], "did you mean effects"),
        (["--versoin"], "did you mean --version"),
        (["effects", "--modle", "axis"], "did you mean --model"),
        (["effects", "--mod", "axis"], "did you mean --model"),
        (["effects", "lugre_fricton"], "did you mean lugre_friction"),
        (["effects", "dead_zone", "surplus"], "unexpected argument 'surplus'"),
        (["effects", "--json", "no/such/folder/x.json"], "mkdir -p no/such/folder"),
    ],
)
def test_wrong_usage_is_one_sentence_that_helps(
    arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main.main(arguments) == 2
    captured = capsys.readouterr()
    assert sentence in captured.err
    assert captured.err.startswith("pneumo: error: ")
    assert captured.err.count("\n") == 1
    assert captured.out == ""


@pytest.mark.parametrize(("failure", "code"), [(DataError, 3), (NumericalError, 4), (KeyboardInterrupt, 130)])
def test_exit_codes(
    failure: type[BaseException], code: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(*_: object) -> int:
        raise failure("this went wrong")

    monkeypatch.setattr(effects, "run", fails)
    assert main.main(["effects"]) == code
    error = capsys.readouterr().err
    assert "Traceback" not in error
    assert ("this went wrong" in error) == issubclass(failure, PneumoError)


def test_a_missing_library_is_named_with_the_command_that_installs_it(tmp_path: Path) -> None:
    done = pneumo("effects", env=environment_without(tmp_path, "yaml"))
    assert done.returncode == 2
    assert done.stderr.startswith("pneumo: error: yaml is not installed")
    assert "-m pip install pyyaml" in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_closed_pipe_is_no_traceback() -> None:
    with subprocess.Popen(
        [sys.executable, "-m", "pneumo_ros", "effects"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == ""
    assert process.returncode == 141


def test_interrupt_ends_with_130() -> None:
    program = "import os,signal; from pneumo_ros.command import main\n"
    program += "from pneumo_ros.command.verb import effects\n"
    program += "effects.run = lambda *_: os.kill(os.getpid(), signal.SIGINT)\nraise SystemExit(main.main(['effects']))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 130
    assert done.stderr == "pneumo: interrupted\n"


def test_as_a_process_in_a_bare_environment(tmp_path: Path) -> None:
    """No home folder, no terminal, another working directory."""
    keep = {name: os.environ[name] for name in ("PATH", "LD_LIBRARY_PATH", "PNEUMO_KERNELS") if name in os.environ}
    root = str(Path(main.__file__).parents[2])
    done = pneumo("effects", "--json", "-", cwd=tmp_path, env={**keep, "PYTHONPATH": root})
    assert done.returncode == 0, done.stderr
    assert {"dead_zone", "lugre_friction"} <= {effect["name"] for effect in json.loads(done.stdout)["effects"]}
