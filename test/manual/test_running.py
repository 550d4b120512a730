"""Every statement and every program of the README and the manual runs, in the order of its page, in an empty folder."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from manual.pages import PAGES, Block, Statement, blocks, statements
from manual.running import run, run_python
from manual.stand_ins import prepare
from manual.unrun import ELSEWHERE, first

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
            found += [one for one in typed if one.block == block.number and not first(ELSEWHERE, one.text)]
            found += [block] if block.language == "python" else []
    return found


def name(step: Step) -> str:
    """Of a test."""
    return step.id if isinstance(step, Statement) else f"{step.page.name}-{step.number}-python"


class Reader:
    """Types a page from its top in a folder of its own; where one step is chosen alone, those before it as well."""

    def __init__(self, page: Path, folder: Path) -> None:
        self.folder = folder
        self._left = [step for step in steps() if step.page == page]
        prepare(page.name, folder)

    def take(self, step: Step) -> None:
        """This step, after those before it that were not taken; one that failed is not tried again for a later one."""
        while step in self._left:
            self._type(self._left.pop(0))

    def _type(self, step: Step) -> None:
        if isinstance(step, Statement):
            typed = statements(step.page)
            run(step, typed[: typed.index(step)], self.folder)
            return
        if "mujoco" in step.text:
            pytest.importorskip("mujoco", reason="comes with the mujoco extra")
        before = blocks(step.page)[: step.number]
        defined = [one.text for one in before if re.search(r"^class ", one.text, re.MULTILINE)]
        given = BEFORE.get((step.page.name, step.number), "")
        run_python("\n".join([*defined, given, step.text]), self.folder)


@pytest.fixture(scope="module")
def reader_of(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Path], Reader]:
    """The reader of a page, from its folder with what the page names."""
    readers = dict[Path, Reader]()

    def reader(page: Path) -> Reader:
        if page not in readers:
            readers[page] = Reader(page, tmp_path_factory.mktemp(page.stem))
        return readers[page]

    return reader


@pytest.mark.check
@pytest.mark.parametrize("step", steps(), ids=name)
def test_it_runs(step: Step, reader_of: Callable[[Path], Reader]) -> None:
    reader = reader_of(step.page)
    reader.take(step)
    if step.page.name == "python.md" and isinstance(step, Block):
        assert "viscous_friction" in (reader.folder / "better.yaml").read_text()
        assert (reader.folder / "waterfall.png").stat().st_size > 5000


@pytest.mark.check
def test_the_tutorial_ends_with_a_better_machine_and_controller(reader_of: Callable[[Path], Reader]) -> None:
    page = next(page for page in PAGES if page.name == "tutorial.md")
    reader = reader_of(page)
    reader.take([step for step in steps() if step.page == page][-1])
    assert "viscous_friction" in (reader.folder / "better.yaml").read_text()
    assert (reader.folder / "my_cascade.yaml").exists()
