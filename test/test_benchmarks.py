"""Assumptions of the benchmarks about the tree."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def rooms_below(room: str) -> set[str]:
    """The room and all rooms that it imports, directly or not, by the table of CONTRIBUTING."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\w+)` \| .+ \| (.*) \|$", text, re.MULTILINE)
    imports = {name: set(re.findall(r"\w+", imported)) for name, imported in rows}
    found, new = set[str](), {room}
    while new := new - found:
        found |= new
        new = {lower for name in new for lower in imports[name]}
    return found


def test_results_of_blind_cases_belong_to_all_the_code_that_a_diagnosis_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Results are stored under a hash of the code: with a missing room they could be those of other code."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import blind_case

    assert set(blind_case.JUDGED) == rooms_below("diagnose")


def test_a_machine_and_its_healthy_partner_are_recorded_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    """Held-out errors of the two are compared, which says something only for the same kind of excitation."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import blind_case

    for seed in range(20):
        for kind, partner in blind_case.PARTNER.items():
            assert blind_case.drawn_excitation(kind, seed) == blind_case.drawn_excitation(partner, seed)
    assert len({blind_case.drawn_excitation("single", seed) for seed in range(60)}) == 7  # all but the usual one
