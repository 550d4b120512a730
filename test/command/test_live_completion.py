"""Tab in a live shell of each kind, which reads the script that the verb prints when it starts."""

import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from command.live_shell import LiveShell

STARTS = {  # shell -> where its script goes, the file that it reads at the start, and what stands there
    "bash": ("pneumo.bash", ".bashrc", 'PS1="ready> "\n. ~/pneumo.bash\n'),
    "zsh": (
        ".zfunc/_pneumo",
        ".zshrc",
        'PS1="ready> "\nfpath=(~/.zfunc $fpath)\nautoload -Uz compinit && compinit -u\n',
    ),
    "fish": (
        ".config/fish/completions/pneumo.fish",
        ".config/fish/config.fish",
        "set -g fish_greeting\nfunction fish_prompt; echo -n 'ready> '; end\n",
    ),
}


@pytest.fixture(params=STARTS)
def shell(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[LiveShell]:
    """An interactive shell in a folder with a recording."""
    name = request.param
    if shutil.which(name) is None:
        pytest.skip(f"no {name} to press Tab in; type: sudo apt install {name}")
    script, start, text = STARTS[name]
    command = [sys.executable, "-m", "pneumo_ros", "completion", name]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    for path, content in ((script, printed), (start, text)):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(content)
    (tmp_path / "bags" / "run_1").mkdir(parents=True)
    live = LiveShell([name, "-i"], tmp_path)
    yield live
    live.close()


def test_tab_completes_verbs_options_effects_machines_and_recordings(shell: LiveShell) -> None:
    shell.wait_for("ready> ")
    for typed, completed in (
        ("pneumo dia", "gnose"),
        ("pneumo effects lug", "re_friction"),
        ("pneumo compare --hor", "izon"),
        ("pneumo compare --model ax", "is"),
        ("pneumo view bags/r", "un_1"),
    ):
        shell.type(f"{typed}\t")
        shell.wait_for(completed)
        shell.type("\x15")  # Ctrl-U empties the line
