"""Every statement and every program of the README and the manual runs, in the order of its page, in an empty folder."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from manual.pages import PAGES, Block, Statement, blocks, statements
from manual.running import run, run_python
from manual.stand_ins import prepare
from manual.unrun import UNRUN, first

BEFORE = {  # page and block -> what its sentence takes for granted
    ("coupling.md", 1): "import pneumo_ros as pn\nmodel = pn.load_model('my.yaml')\nposition, velocity = 0.01, 0.0\n"
    "effective_mass, free_acceleration, time_step, voltage = 5.0, 0.0, 1e-3, 2.0\n",
}
Step = Statement | Block


def steps() -> list[Step]:
    """Statements to run and programs of Python, as they follow each other on each page."""
    found = list[Step]()
    for page in PAGES:
        typed = statements(page)
        for block in blocks(page):
            found += [one for one in typed if one.block == block.number and not first(UNRUN, one.text)]
            found += [block] if block.language == "python" else []
    return found


def name(step: Step) -> str:
    """Of a test."""
    return step.id if isinstance(step, Statement) else f"{step.page.name}-{step.number}-python"


@pytest.fixture(scope="module")
def folder_of(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Path], Path]:
    """The folder of a page, with what the page names, made once."""
    made = dict[Path, Path]()

    def folder(page: Path) -> Path:
        if page not in made:
            made[page] = tmp_path_factory.mktemp(page.stem)
            prepare(page.name, made[page])
        return made[page]

    return folder


@pytest.mark.check
@pytest.mark.parametrize("step", steps(), ids=name)
def test_it_runs(step: Step, folder_of: Callable[[Path], Path]) -> None:
    folder = folder_of(step.page)
    if isinstance(step, Statement):
        typed = statements(step.page)
        run(step, typed[: typed.index(step)], folder)
        return
    if "mujoco" in step.text:
        pytest.importorskip("mujoco", reason="comes with the mujoco extra")
    defined = [one.text for one in blocks(step.page)[: step.number] if re.search(r"^class ", one.text, re.MULTILINE)]
    run_python("\n".join([*defined, BEFORE.get((step.page.name, step.number), ""), step.text]), folder)
    if step.page.name == "python.md":
        assert "viscous_friction" in (folder / "better.yaml").read_text()
        assert (folder / "waterfall.png").stat().st_size > 5000


@pytest.mark.check
def test_the_tutorial_ends_with_a_better_machine_and_controller(folder_of: Callable[[Path], Path]) -> None:
    """After the statements above."""
    folder = folder_of(next(page for page in PAGES if page.name == "tutorial.md"))
    assert "viscous_friction" in (folder / "better.yaml").read_text()
    assert (folder / "my_cascade.yaml").exists()
