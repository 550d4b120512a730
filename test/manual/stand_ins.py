"""What the statements of a page name and do not make themselves: small recordings, tables and machine files."""

import csv
import re
import shlex
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from manual.pages import ROOT

import pneumo_ros as pn
from pneumo_ros.command.main import main

NOISE = {"position": 5e-6, "pressure_a": 200.0, "pressure_b": 200.0}  # m, Pa
SHEET = "--bore 25 --rod 10 --stroke 200 --valve-flow 'qn 700 l/min' --supply 6barg --mass 2"
OWN = (ROOT / "docs" / "own_effect.md").read_text(encoding="utf-8").split("```python\n")[1].split("```")[0]
LEAKY = "end_stop, seal_leak]"
ARM = """<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>
<site name="base" pos="0.05 0 0.3"/><body pos="0 0 1"><joint name="shoulder" type="hinge" axis="0 1 0" damping="0.5"/>
<geom type="capsule" fromto="0 0 0 0.7 0 0" size="0.03" mass="8"/><site name="clevis" pos="0.3 0 -0.04"/></body>
</worldbody><tendon><spatial name="lift"><site site="base"/><site site="clevis"/></spatial></tendon></mujoco>"""


def prepare(page: str, folder: Path) -> None:
    """Put into the folder what the statements of a page need."""
    (folder / "config").symlink_to(ROOT / "pneumo_ros" / "config")
    for make in MADE.get(page, ()):
        make(folder)


def rig() -> pn.Model:
    """The default machine with a friction that it does not know."""
    axis = pn.load_model("axis")
    return axis.with_effects([*axis.effects, "viscous_friction"], {"viscous_friction.coefficient": 150.0})


def recorded(
    folder: Path,
    drives: dict[str, str],
    seconds: float = 6.0,
    sent: Callable[[pn.Recording], pn.Recording] = lambda r: r,
) -> None:
    """A recording of the rig for each drive, as it is `sent`."""
    for k, (name, drive) in enumerate(drives.items()):
        one = pn.simulate(rig(), drive, seconds=seconds, noise=NOISE, seed=k, name=name)
        pn.save(sent(one), folder / name)


def runs(folder: Path) -> None:
    """Sines, one of them held out, and strokes."""
    recorded(folder / "runs", {"first": "sine:3,0.5", "strokes": "sine:5,0.9", "holdout_a": "sine:4,0.7"})


def named_runs(folder: Path) -> None:
    """The names of docs/python.md."""
    recorded(folder / "runs", {"slow": "sine:3,0.5", "fast": "sine:5,0.9", "hold_out": "sine:4,0.7"})


def loose_runs(folder: Path) -> None:
    """Recordings beside each other, by their names."""
    recorded(folder, {"train_a": "sine:3,0.5", "train_b": "sine:5,0.9", "holdout_a": "sine:4,0.7"})


def constants(folder: Path, name: str = "constants") -> None:
    """Constant voltages in both directions."""
    for k, volts in enumerate((1.2, -1.2, 2.0, -2.0, 5.0, -5.0)):
        one = pn.simulate("axis", f"step:{volts}@0.5", seconds=3.5, position=-0.3 * np.sign(volts), noise=NOISE, seed=k)
        pn.save(one, folder / name / f"constant_{k}")


def constant_runs(folder: Path) -> None:
    """Constant voltages, as the folder `runs`."""
    constants(folder, "runs")


def axis_file(folder: Path) -> None:
    """A machine file of the user's own."""
    pn.save_model(pn.load_model("axis"), folder / "my_axis.yaml")


def my_file(folder: Path) -> None:
    """Another name of it."""
    pn.save_model(pn.load_model("axis"), folder / "my.yaml")


def effects_file(folder: Path) -> None:
    """The effect of docs/own_effect.md, under two names."""
    for name in ("my_effects.py", "mine.py"):
        (folder / name).write_text(OWN)


def leaky(folder: Path) -> None:
    """A machine file that lists the effect."""
    text = (ROOT / "config" / "axis.yaml").read_text().replace("end_stop]", LEAKY)
    (folder / "leaky.yaml").write_text(text + "    seal_leak: {conductance: 1.0e-7}\n")


def tables(folder: Path) -> None:
    """CSV files of the machine of the data sheet, with units in the headings, as a logger writes them."""
    assert main(["new", *shlex.split(SHEET), "--out", str(folder / "sheet.yaml"), "--quiet"]) == 0
    sheet = pn.load_model(folder / "sheet.yaml")
    real = sheet.with_effects([*sheet.effects, "viscous_friction"], {"viscous_friction.coefficient": 90.0})
    drives = {"run": "sine:2.2,0.9", "run_1": "sine:2.5,1", "run_2": "sine:4,1.7", "hold_1": "sine:3,1.3"}
    for k, (name, drive) in enumerate(drives.items()):
        write_csv(pn.simulate(real, drive, seconds=5.0, noise=NOISE, seed=k), folder / f"{name}.csv")
    (folder / "sheet.yaml").unlink()


def write_csv(recording: pn.Recording, path: Path) -> None:
    """Time, position in mm from the retracted end, gauge pressures in bar, and volts."""
    assert recording.pressure_a is not None
    assert recording.pressure_b is not None
    assert recording.voltage is not None
    gauge = (1e-5 * (one - 101325.0) for one in (recording.pressure_a, recording.pressure_b))
    columns = (recording.time, 1e3 * recording.position + 100.0, *gauge, recording.voltage)
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("time [s]", "position [mm]", "pressure a [barg]", "pressure b [barg]", "valve [V]"))
        writer.writerows(zip(*(np.round(one, 7).tolist() for one in columns), strict=True))


def commissioned(folder: Path) -> None:
    """What a commissioning in the namespace `rig` leaves: its machine, its rig file, its moves by the page's names."""
    pn.save_model(pn.load_model("axis"), folder / "mine.yaml")
    words = "machine: mine.yaml, namespace: rig, closed: 5V, read_as: 'bar,gauge'"
    (folder / "mine_rig.yaml").write_text(f"rig: {{{words}}}\n")
    held = re.findall(r"mended/(\w+/\w+)", (ROOT / "docs" / "commissioning.md").read_text(encoding="utf-8"))
    assert held, "docs/commissioning.md names no recordings to hold out"
    moves = {"03_sines/train_sines": "sine:3,0.5"} | {name: f"sine:{5 - k},0.9" for k, name in enumerate(held)}
    recorded(folder / "mended", moves, sent=by_the_rig)


def by_the_rig(one: pn.Recording) -> pn.Recording:
    """The recording as a rig with gauges in bar and a valve of 0 to 10 V sends it, in its namespace."""
    assert one.pressure_a is not None
    assert one.pressure_b is not None
    assert one.command is not None
    a, b = (1e-5 * (pressure - 101325.0) for pressure in (one.pressure_a, one.pressure_b))
    return replace(one, namespace="rig", pressure_a=a, pressure_b=b, command=one.command + 5.0)


def launched(folder: Path) -> None:
    """What a launch file has recorded."""
    recorded(folder, {"run_1": "sine:3,0.5"})


def launch_files(folder: Path) -> None:
    """Machine files, gains and a rig file that launch files take."""
    for name in ("plant.yaml", "guess.yaml"):
        pn.save_model(pn.load_model("axis"), folder / name)
    (folder / "my_cascade.yaml").write_text((ROOT / "config" / "control" / "cascade.yaml").read_text())
    (folder / "rig.yaml").write_text("rig:\n  machine: guess.yaml\n  namespace: cylinder_1\n")


def arm(folder: Path) -> None:
    """An arm that its cylinder lifts."""
    (folder / "arm.xml").write_text(ARM)


def leaks(folder: Path) -> None:
    """Machines as the folder `fleet`."""
    rigs(folder, ("fleet",))


def rigs(folder: Path, names: tuple[str, ...] = ("rigs", "fleet_folder")) -> None:
    """Two machines with two campaigns each."""
    for name in names:
        for machine in ("a", "b"):
            for week in ("week_0", "week_1"):
                constants(folder / name / machine, week)


MADE: dict[str, tuple[Callable[[Path], None], ...]] = {
    "README.md": (runs, constants, tables, leaky, rigs),
    "commissioning.md": (commissioned,),
    "control.md": (axis_file,),
    "coupling.md": (my_file, arm),
    "export.md": (axis_file,),
    "finding.md": (runs, loose_runs, effects_file),
    "fleet.md": (rigs,),
    "identification.md": (constant_runs, launch_files),
    "import.md": (tables,),
    "nodes.md": (commissioned, my_file, axis_file, launch_files, launched),
    "python.md": (named_runs, my_file),
    "recordings.md": (runs, my_file),
    "trust.md": (leaks,),
    "workbench.md": (runs, axis_file, effects_file),
}
