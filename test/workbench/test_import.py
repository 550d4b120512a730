"""Tables, units and numbers of the machine, edited in the page; and effects that are searched."""

from pathlib import Path
from typing import Any

import pytest
from workbench.conftest import Served
from workbench.leaking import SECONDS
from workbench.tab import Tab

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model
from pneumo_ros.plant.machine_file import read_machine
from pneumo_ros.records import read_recording
from pneumo_ros.tables.map_file import parse_map
from pneumo_ros.workbench.desk import Desk, Given
from pneumo_ros.workbench.mapping import Mapped, edited, free_name
from pneumo_ros.workbench.quantity import typed
from pneumo_ros.workbench.uploads import TABLES, place

NARROW = 420
GUESS = {"time": {"column": "t"}, "signals": {"position": {"column": "x"}}, "unused": {"p": "1 to 6"}, "open": []}
CONTENT = {"time": {"column": "t", "unit": "s"}, "signals": {"position": {"column": "x", "unit": "mm", "bits": 16}}}
MAPPED = Mapped("run.csv", "map.yaml", GUESS, CONTENT)


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("0.25", "m", 0.25), ("250 mm", "m", 0.25), ("6bar", "Pa", 6e5), ("5 barg", "Pa", 6e5),
        ("1e-9", "kg/(s Pa)", 1e-9), ("20 degC", "K", 293.15), ("3 kg", "kg", 3.0),
    ],
)  # fmt: skip
def test_a_number_may_have_a_unit(text: str, unit: str, value: float) -> None:
    assert typed(text, "x", unit, 1e5) == pytest.approx(value)


@pytest.mark.parametrize("text", ["", "six", "6 mm", "6 furlongs", "1e999", "1,5"])
def test_what_is_no_number_of_that_unit_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match=r"^air\.supply_pressure"):
        typed(text, "air.supply_pressure", "Pa", 1e5)


def test_a_map_keeps_what_the_form_does_not_show() -> None:
    row = {"column": "x", "unit": "in", "sign": -1, "offset": "-40"}
    gone: dict[str, Any] = {"column": None, "unit": None, "sign": 1, "offset": 0}
    content = edited(MAPPED, {"column": "t", "unit": "ms"}, {"position": row, "velocity": gone}, "imposed")
    assert content["signals"] == {"position": {"bits": 16, **row}}
    plan = parse_map(content)
    assert (plan.imposed, plan.timing.unit, plan.signals["position"].offset) == (True, "ms", -40.0)
    with pytest.raises(UsageError, match=r"signals\.position\.unit is bar"):
        edited(MAPPED, {"column": "t"}, {"position": row | {"unit": "bar"}}, "free")
    assert MAPPED.columns == ["t", "x", "p"]


def test_a_table_has_a_place_of_its_own(tmp_path: Path) -> None:
    assert place(tmp_path, f"{TABLES}/run.csv.gz") == tmp_path / TABLES / "run.csv.gz"
    with pytest.raises(UsageError, match="no table that is read"):
        place(tmp_path, f"{TABLES}/run.xlsx")
    (tmp_path / "run").mkdir()
    assert free_name("run", tmp_path) == "run_2"


def test_another_machine_file_begins_again_and_a_wrong_one_is_refused(tmp_path: Path) -> None:
    desk = Desk(tmp_path, Given())
    desk.take_machine("paper", "example paper")
    assert ([v.label for v in desk.lineage()], desk.model().name) == (["example paper"], "paper")
    (tmp_path / "wrong.yaml").write_text("effects: [no_such_effect]")
    with pytest.raises(UsageError):
        desk.take_machine("wrong.yaml", "wrong")
    assert desk.current == 1


def test_units_of_recordings_are_typed_in_the_page(tmp_path: Path, leaking: Path) -> None:
    desk = Desk(tmp_path, Given((str(leaking),)))
    desk.shelf.read_as("bar, gauge")
    assert desk.shelf.how.words == ("bar", "gauge")
    with pytest.raises(UsageError, match="--read-as"):
        desk.shelf.read_as("furlongs")


def table_of(recording: Path, path: Path) -> None:
    """Part of a recording as a table with other units, and a valve that is closed at 5 V."""
    run, lines = read_recording(recording), ["t [s];stroke [mm];p_a [bar];p_b [bar];u [V]"]
    assert run.voltage is not None
    columns = (run.time, 1e3 * run.position, 1e-5 * run.signals["pressure_a"], 1e-5 * run.signals["pressure_b"],
               run.voltage + 5.0)  # fmt: skip
    lines += [";".join(f"{value:.6f}" for value in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join(lines))


def choose(tab: Tab, name: str, path: Path) -> None:
    """Choose a file by a button."""
    with tab.page.expect_file_chooser() as chooser:
        tab.press(name)
    chooser.value.set_files(path)


@pytest.mark.check
def test_a_table_is_mapped_and_a_machine_edited_in_a_narrow_page(
    browser: Any, served: Served, leaking: Path, tmp_path: Path
) -> None:
    table_of(leaking / "train_steps", tmp_path / "mine.csv")
    (tmp_path / "my_rig.yaml").write_text(read_machine("axis")[1])
    tab = Tab(browser, served.address, NARROW)
    try:
        tab.view("Import")
        choose(tab, "Choose a table", tmp_path / "mine.csv")
        form = tab.see("#mapping", "Columns of mine.csv")
        assert tab.page.evaluate("document.documentElement.scrollWidth") <= NARROW
        form.get_by_label("offset of the valve command").fill("-5")
        tab.press("Import this table")
        tab.see("#bags", "mine")
        tab.view("Rig")
        choose(tab, "Choose a machine file", tmp_path / "my_rig.yaml")
        tab.see("#machine", "my_rig.yaml")
        tab.see("#numbers").get_by_label("supply pressure").first.fill("6.5 bar")
        tab.press("Keep these numbers")
        tab.see("#machine", "my_rig_2.yaml (by hand)")
        assert tab.page.evaluate("document.documentElement.scrollWidth") <= NARROW
        tab.view("Save")
        assert "pneumo import" in tab.see("#commands", "air.supply_pressure = 650000").inner_text()
        with tab.page.expect_download() as download:
            tab.page.get_by_role("link", name="Save the machine file: my_rig_2.yaml").click()
        download.value.save_as(tmp_path / "kept.yaml")
        assert load_model(str(tmp_path / "kept.yaml"))["air.supply_pressure"] == 6.5e5
        tab.page.get_by_label("Search").fill("leak rod")
        tab.page.get_by_label("friction lag", exact=True).wait_for(state="hidden")
        assert tab.page.get_by_label("leakage to atmosphere", exact=True).is_visible()
        tab.page.get_by_role("button", name="mine", exact=True).click()
        tab.see(".bag.shown", "mine")
        drawn = read_recording(leaking / "train_steps").position[0] * 1e3  # mm, not those of the run before
        found = tab.wait_for_traces(lambda traces: len(traces) == 4 and abs(traces[0]["y"][0] - drawn) < 1e-3)
        assert max(found[-1]["y"]) < 5.0  # V: without its offset the command is 5 V higher
        assert found[0]["x"][-1] == pytest.approx(SECONDS, abs=0.1)
        assert tab.complaints == []
    finally:
        tab.close()
