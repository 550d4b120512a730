"""The notebook of the documentation runs, and shows what it promises."""

from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.check
NOTEBOOK = Path(__file__).parents[2] / "docs/notebooks/recordings_to_model.ipynb"


@pytest.fixture(scope="module")
def cells() -> list[Any]:
    """The code cells with their outputs, run afresh."""
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def outputs(cell: Any, kind: str) -> list[str]:
    """What a cell shows as `kind` of MIME."""
    return [one.data[kind] for one in cell.outputs if kind in one.get("data", {})]


def test_it_finds_the_hidden_effect(cells: list[Any]) -> None:
    diagnosed = next(cell for cell in cells if cell.source.startswith("found = pn.diagnose"))
    (shown,) = outputs(diagnosed, "text/html")
    assert "lacks viscous_friction" in shown
    compared = next(cell for cell in cells if cell.source.startswith("before = "))
    assert "momentum fails" in outputs(compared, "text/html")[0]


def test_its_charts_are_pictures(cells: list[Any]) -> None:
    drawn = [cell for cell in cells if "plot(" in cell.source]
    assert len(drawn) == 2
    assert all(len(outputs(cell, "image/png")) == 1 for cell in drawn)


def test_the_stored_outputs_are_those_of_this_code(cells: list[Any]) -> None:
    nbformat = pytest.importorskip("nbformat")
    stored = [cell for cell in nbformat.read(NOTEBOOK, as_version=4).cells if cell.cell_type == "code"]
    for now, before in zip(cells, stored, strict=True):
        assert len(outputs(now, "text/html")) == len(outputs(before, "text/html")), now.source
        assert len(outputs(now, "image/png")) == len(outputs(before, "image/png")), now.source
