"""Faults in files: a disk that is full, one that cannot be written, recordings and other things that are damaged.

Small disks are mounted in memory, which needs root; `available` is False where that is impossible.
"""

import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fuzz.mutation import mutate
from fuzz.recordings import mcap_seeds
from ros.processes import node, running

from chaos.field import ANSWER, PLACE, Field, hold
from pneumo_ros.records import Bag

COMMAND = ("-m", "pneumo_ros")


@contextmanager
def small_disk(folder: Path, size: int) -> Iterator[Path]:
    """A disk of `size` bytes, mounted in `folder` for the duration of the block."""
    place = folder / f"disk_{time.monotonic_ns()}"
    place.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", place], check=True, capture_output=True)
    try:
        yield place
    finally:
        subprocess.run(["umount", "-l", place], check=True, capture_output=True)


def available(folder: Path) -> bool:
    """Whether disks can be mounted here."""
    try:
        with small_disk(folder, 1 << 16):
            return True
    except (subprocess.CalledProcessError, FileNotFoundError):
        return False


def full_disk_recorder(field: Field) -> None:
    """The disk fills while a recorder writes: exit code 3, a message, and a recording that other readers accept."""
    with small_disk(field.folder, field.random.randrange(100, 400) << 10) as disk:
        recorder = field.run("recorder", output=disk / "bag")
        code = recorder.process.wait(60.0)
        recorder.end(None)
        said = recorder.said[-500:]
        hold(code == 3 and "No space left" in said and "Traceback" not in said, f"exit code {code}: {said}")
        bag = Bag(disk / "bag")
        hold(sum(bag.overview().counts.values()) > 100, "little was recorded before the disk was full")
        hold(not any("breaks off" in warning for warning in bag.warnings), f"{bag.warnings}")


def full_disk_machine_file(field: Field) -> None:
    """The disk is full when a machine file is replaced: the old one stays, and no other file remains."""
    with small_disk(field.folder, 1 << 20) as disk:
        out = disk / "machine.yaml"
        out.write_text("old")
        (disk / "filler").write_bytes(bytes((1 << 20) - (3 << 12)))
        (disk / "rest").write_bytes(bytes(4096))
        text = _command(field, "simulate", "--input", "constant:1", "--seconds", "3", "--out", str(disk / "run"))
        hold("No space left" in text and "Traceback" not in text, text)
        text = _command(field, "effects", "--json", str(out), quiet_code=(0, 3))
        hold("Traceback" not in text, text)
        hold(out.read_text() == "old" or out.read_text().startswith("{"), "half a file was written")
        names = sorted(path.name for path in disk.iterdir())
        hold(names == ["filler", "machine.yaml", "rest"], f"left behind: {names}")


def read_only_folder(field: Field) -> None:
    """A read-only disk: recorder, commands and machine files report it, with exit codes 2 or 3."""
    with small_disk(field.folder, 1 << 20) as disk:
        subprocess.run(["mount", "-o", "remount,ro", disk], check=True, capture_output=True)
        recorder = field.run("recorder", output=disk / "bag")
        hold(recorder.process.wait(ANSWER) == 3, f"recorder: {recorder.end(None)} {recorder.said[-300:]}")
        for more in (
            ("simulate", "--input", "constant:1", "--out", str(disk / "run")),
            ("effects", "--json", str(disk / "x")),
        ):
            text = _command(field, *more, quiet_code=(2, 3))
            hold("Traceback" not in text and "disk_" in text, text)
        hold(not list(disk.iterdir()), "something was written")


def _command(field: Field, *words: str, quiet_code: tuple[int, ...] = (3,)) -> str:
    with running(*COMMAND, *words, cwd=field.folder) as process:
        code = process.process.wait(ANSWER)
        process.end(None)
        hold(code in quiet_code, f"pneumo {words[0]} ended with {code}: {process.said[-300:]}")
        return process.said


def damaged_player(field: Field) -> None:
    """A player of a damaged recording, on its own topics; killed if it still plays."""
    path = field.folder / "damaged.mcap"
    path.write_bytes(
        mutate(field.random.choice(mcap_seeds()), field.random.randrange(1, 6), field.random.getrandbits(32))
    )
    with running(*node("player", input=path, wait=0.0, loop=field.random.random() < 0.5), cwd=field.folder) as player:
        end = time.monotonic() + 4.0
        while player.process.poll() is None and time.monotonic() < end:
            time.sleep(0.02)
        if player.process.poll() is None:
            player.process.kill()
        else:
            hold(
                player.process.returncode in (0, 3),
                f"player ended with {player.process.returncode}: {player.said[-500:]}",
            )
            hold("Traceback" not in player.said, player.said[-500:])


def rubbish_in_the_folder(field: Field) -> None:
    """Files appear in the folder that the identification watches, and vanish again."""
    folder = field.folder / "runs" / f"odd_{time.monotonic_ns()}"
    folder.mkdir()
    kind = field.random.choice(("damaged", "text", "empty", "vanishing", "metadata"))
    data = mutate(mcap_seeds()[0], 3, field.random.getrandbits(32)) if kind != "empty" else b""
    (folder / f"x.{'mcap' if kind != 'text' else 'db3'}").write_bytes(data)
    if kind == "metadata":
        (folder / "metadata.yaml").write_text("rosbag2_bagfile_information: [")
    if kind == "vanishing":
        time.sleep(0.2)
        for path in folder.iterdir():
            path.unlink()
        folder.rmdir()
    time.sleep(0.5)
    health = field.probe.health(f"{PLACE}/identification")[1]
    hold("stage" in health, "the identification says nothing")


DISKS: dict[str, Callable[[Field], Any]] = {
    "disk full while recording": full_disk_recorder,
    "disk full while writing files": full_disk_machine_file,
    "read-only folder": read_only_folder,
}
FILES: dict[str, Callable[[Field], Any]] = {
    "player of a damaged recording": damaged_player,
    "rubbish beside recordings": rubbish_in_the_folder,
}
