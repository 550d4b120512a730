"""Machine files of several axes: read as written, shared sections, errors that name the axis."""

from pathlib import Path

import pytest
from multiaxis.machines import LINE, two

from pneumo_ros.errors import UsageError
from pneumo_ros.multiaxis import load_machine, machine_text
from pneumo_ros.plant import load_model
from pneumo_ros.plant.axes_section import from_anywhere
from pneumo_ros.reading.rig_file import read_rig
from pneumo_ros.workbench.desk import Desk, Given

PRUNING = Path(__file__).parents[2] / "pneumo_ros" / "config" / "arm" / "pruning.yaml"
TEXT = machine_text(two(LINE))


def written(folder: Path, text: str) -> Path:
    path = folder / "two.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_is_read_as_it_was_written(tmp_path: Path) -> None:
    again = load_machine(written(tmp_path, TEXT))
    assert machine_text(again) == TEXT
    assert again.as_dict() == two(LINE).as_dict()
    assert list(again.axes) == ["shoulder", "elbow"]
    assert load_machine(written(tmp_path, machine_text(two()))).supply is None


def test_an_axis_of_a_file_is_found_from_another_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = written(tmp_path, TEXT)
    (tmp_path / "rig.yaml").write_text("rig:\n  machine: two.yaml:elbow\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert from_anywhere("two.yaml:elbow") == f"{file.resolve()}:elbow"
    assert from_anywhere("axis") == "axis"
    desk = Desk(tmp_path / "elsewhere", Given(machine="two.yaml:elbow"))
    monkeypatch.chdir("/")
    assert desk.model().as_dict() == load_model(desk.variant.machine).as_dict() == two(LINE).axes["elbow"].as_dict()
    assert load_model(read_rig(tmp_path / "rig.yaml").machine).name == "two:elbow"


def test_one_axis_of_several_is_a_machine(tmp_path: Path) -> None:
    path = written(tmp_path, TEXT)
    elbow = load_model(f"{path}:elbow")
    assert elbow.name == "two:elbow"
    assert elbow.as_dict() == load_model("axis").as_dict()
    with pytest.raises(UsageError, match=rf"axes shoulder, elbow; say which, such as {path}:shoulder"):
        load_model(path)
    with pytest.raises(UsageError, match="did you mean elbow"):
        load_model(f"{path}:elbw")


def test_shared_sections_hold_for_the_axes_that_use_them() -> None:
    for axis in ("lift", "reach"):
        one, alone = load_model(f"{PRUNING}:{axis}"), load_model(PRUNING.with_name(f"{axis}.yaml"))
        assert one.as_dict() == alone.as_dict()
    assert load_machine(PRUNING).supply == {"resistance_supply": 5e6, "time_constant": 0.3}


BAD = {
    "no list": (TEXT.replace("[shoulder, elbow]", "shoulder"), r"'axes' is 'shoulder'; it takes a list of names"),
    "twice": (TEXT.replace("[shoulder, elbow]", "[elbow, elbow]"), r"axis elbow is listed twice"),
    "no section": (TEXT.replace("[shoulder,", "[wrist, shoulder,"), r"axis wrist has no section of its own"),
    "no name": (TEXT.replace("[shoulder,", "[a/b, shoulder,"), r"axis 'a/b' is no name for topics"),
    "in an axis": (TEXT.replace("mass: 9.0", "mass: -9.0"), r"axis shoulder: piston.mass is -9.0 kg; allowed"),
    "line": (TEXT.replace("  time_constant: 0.3", "  time_constnt: 0.3"), r"did you mean time_constant"),
    "line in part": (TEXT.replace("  time_constant: 0.3", "  #"), r"beside the axes lacks time_constant"),
    "not used": (
        TEXT.replace("    shoulder:\n", "    aer: {}\n    shoulder:\n"),
        r"did you mean air\?; no axis uses it",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_file_is_refused_with_the_place(case: str, tmp_path: Path) -> None:
    text, sentence = BAD[case]
    with pytest.raises(UsageError, match=sentence):
        load_machine(written(tmp_path, text))


def test_a_file_of_one_axis_has_no_names(tmp_path: Path) -> None:
    path = tmp_path / "my.yaml"
    path.write_text("/**:\n  ros__parameters:\n    effects: [end_stop]\n", encoding="utf-8")
    with pytest.raises(UsageError, match=r"holds one axis without a name; type .*my.yaml instead of .*my.yaml:elbow"):
        load_model(f"{path}:elbow")
    with pytest.raises(UsageError, match=r"no 'axes'; load it by load_model"):
        load_machine(path)
