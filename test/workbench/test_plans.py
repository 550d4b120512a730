"""The command lines of the buttons; the memory of a desk; and the verb's messages for wrong use."""

import socket
from pathlib import Path

import pytest
from hiding import environment_without
from multiaxis.machines import two
from workbench.conftest import Served

from pneumo_ros.command.main import main
from pneumo_ros.errors import UsageError
from pneumo_ros.multiaxis import machine_text
from pneumo_ros.plant import load_model
from pneumo_ros.reading.read import ReadOptions
from pneumo_ros.workbench.bags import Bag, found_bags
from pneumo_ros.workbench.desk import Desk, Given, commands
from pneumo_ros.workbench.plans import Bench, campaign_plan, compare_plan, diagnose_plan, refit_plan
from pneumo_ros.workbench.save_panel import saved_files
from pneumo_ros.workbench.variant import Variant

BAGS = (
    Bag("a", "/data/a", "fit", cuts=((1.0, 2.5),)), Bag("b", "/data/b", "hold"), Bag("c", "/data/c", "out"),
    Bag("d", "/data/d", "fit", problem="broken"),
)  # fmt: skip
BENCH = Bench(BAGS, ReadOptions(namespace="rig", words=("bar",)), "axis_1.yaml", ("/data/mine.py",))
HOW = "--model axis_1.yaml --effects /data/mine.py --namespace rig --read-as bar --cut /data/a:1-2.5"


def test_refit_is_add_with_the_recordings_in_their_roles() -> None:
    plan = refit_plan(BENCH, ["payload_mass"], "axis_2.yaml", 3)
    assert (plan.machine, plan.made, plan.compared, plan.recordings) == ("axis_2.yaml", "made_3", "compared_3", "")
    add, compare = plan.shown()
    files = "--out axis_2.yaml --json made_3.json --report made_3.html"
    assert add == f"pneumo add payload_mass /data/a --holdout /data/b {HOW} {files}"
    assert compare.startswith("pneumo compare /data/a /data/b --model axis_2.yaml ")
    alone = refit_plan(BENCH, [], "axis_2.yaml", 3).shown()[0]
    assert alone == f"pneumo compare /data/b --fit /data/a {HOW} {files}"


def test_what_is_left_out_or_broken_takes_no_part() -> None:
    plan = compare_plan(BENCH, 1)
    assert plan.bags == ("a", "b")
    assert "/data/c" not in plan.shown()[0]
    assert "/data/d" not in plan.shown()[0]
    assert diagnose_plan(BENCH, "axis_2.yaml", 3).shown()[0].startswith("pneumo diagnose /data/a --holdout /data/b ")


def test_the_campaign_is_an_experiment() -> None:
    line = "pneumo experiment constant-voltage --namespace cylinder --out campaign_4 --model axis_1.yaml"
    line += " --effects /data/mine.py"
    assert campaign_plan(BENCH, "cylinder", "campaign_4", "5V").shown() == (f"{line} --read-as bar --closed 5V",)


def test_the_campaign_takes_the_rig_file() -> None:
    """It holds wiring, limits and the signal that closes the valve."""
    bench = Bench(BAGS, ReadOptions(words=("bar",)), "axis_1.yaml", (), rig="/data/rig.yaml")
    line = "pneumo experiment constant-voltage --out campaign_4 --model axis_1.yaml --rig /data/rig.yaml"
    assert campaign_plan(bench, "", "campaign_4").shown() == (line,)


def test_a_diagnosis_needs_both_roles() -> None:
    alone = Bench(BAGS[:1], ReadOptions(), "axis", ())
    with pytest.raises(UsageError, match="mark one 'hold out'"):
        diagnose_plan(alone, "axis_1.yaml", 1)


def test_recordings_of_one_name_are_distinguished(tmp_path: Path) -> None:
    for name in ("one/run", "two/run", "two/holdout"):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "metadata.yaml").touch()
    bags = found_bags([tmp_path / "one", tmp_path / "two", tmp_path / "one" / "run"])
    assert [(bag.name, bag.role) for bag in bags] == [("one/run", "fit"), ("holdout", "hold"), ("two/run", "fit")]


def test_an_effect_is_taken_out_and_values_are_kept(tmp_path: Path) -> None:
    desk = Desk(tmp_path, Given())
    desk.by_hand({"piston.mass": 6.0})
    assert load_model(str(tmp_path / "axis_1.yaml"))["piston.mass"] == 6.0
    assert commands(desk.lineage()) == "# set by hand: piston.mass = 6; from axis, saved as axis_1.yaml"
    with pytest.raises(UsageError, match=r"piston\.mass"):
        desk.by_hand({"piston.mass": -1.0})
    desk.undo()
    assert (desk.current, len(desk.variants)) == (0, 2)
    desk.ticked -= {"quadratic_drag"}
    with pytest.raises(UsageError, match="no recording is marked 'fit'"):
        desk.refit()


def test_a_port_that_is_taken_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        assert main(["workbench", "--port", str(port), "--quiet"]) == 2
    assert f"cannot listen on port {port}" in capsys.readouterr().err


def test_a_wrong_machine_file_is_reported_before_anybody_opens_the_page(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["workbench", "--port", "0", "--model", "axs", "--quiet"]) == 3
    assert "axis" in capsys.readouterr().err


def test_without_its_library_it_says_how_to_get_it(tmp_path: Path) -> None:
    import subprocess
    import sys

    line = [sys.executable, "-m", "pneumo_ros", "workbench", "--port", "0"]
    environment = environment_without(tmp_path, "dash")
    done = subprocess.run(line, env=environment, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert "dash is not installed" in done.stderr
    assert "pip install dash" in done.stderr


def test_it_listens_to_this_machine_alone(tmp_path: Path) -> None:
    running = Served(tmp_path)
    try:
        listening = Path(f"/proc/{running.process.pid}/net/tcp").read_text().splitlines()
        own = [line.split()[1] for line in listening if line.split()[1].endswith(f":{running.port:04X}")]
        assert own
        assert all(address.startswith("0100007F:") for address in own)
    finally:
        assert running.close() == 0


def test_an_effect_is_added_to_one_axis_of_several(tmp_path: Path) -> None:
    (tmp_path / "two.yaml").write_text(machine_text(two()), encoding="utf-8")
    desk = Desk(tmp_path, Given(machine=str(tmp_path / "two.yaml") + ":elbow"))
    bench = Bench((Bag("run", "/run", "fit"),), ReadOptions(), desk.variant.machine, ())
    plan = refit_plan(bench, ["spring_load"], "two_1.yaml", 1)
    assert plan.machine == "two_1.yaml:elbow"
    adding, comparing = (list(line.arguments) for line in plan.lines)
    assert adding[adding.index("--out") + 1] == "two_1.yaml"
    assert comparing[comparing.index("--model") + 1] == "two_1.yaml:elbow"
    (tmp_path / "two_1.yaml").write_text(machine_text(two()), encoding="utf-8")
    desk.variants.append(Variant(1, plan.machine, "more", 0))
    desk.choose(1)
    assert desk.model().name == "two_1:elbow"
    assert saved_files(desk)["two_1.yaml"][1] == tmp_path / "two_1.yaml"
