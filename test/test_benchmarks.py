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


def test_every_effect_that_shows_in_motion_has_a_term_in_the_library_of_pysindy(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An effect without a term could never be named, which would say nothing about the method."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    from peer_terms import TERMS

    from pneumo_ros.diagnose.hypothesis import missing
    from pneumo_ros.plant import load_model

    named = {term.effect for term in TERMS}
    assert set(missing(load_model("axis"))) - named == {"dwell_time_breakaway"}  # it acts at rest
    assert named <= set(missing(load_model("axis")))


def test_results_of_other_methods_belong_to_all_their_files(monkeypatch: pytest.MonkeyPatch) -> None:
    """Results are stored under a hash of these files; the two others run the methods and print."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import peer_case

    files = {name for names in peer_case.OWN_FILES.values() for name in names}
    every = {path.name for path in (ROOT / "benchmarks").glob("peer_*.py")}
    assert every - files == {"peer_case.py", "peer_tables.py"}


def test_a_method_is_right_if_it_names_the_hidden_effect_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import peer_tables

    machine = {"seed": 1, "strength": 0.5, "excitation": "steps", "hidden": ["line_delay:volume"], "wall": 2.0}
    names = {"best": ["line_delay"], "fair": ["line_delay", "backlash"], "poor": ["backlash", "line_delay"], "mute": []}
    results = [{**machine, "method": method, "named": named} for method, named in names.items()]
    assert [peer_tables.first_right(one) for one in results] == [True, True, False, False]
    assert [peer_tables.alone_right(one) for one in results] == [True, False, False, False]
    printed = peer_tables.table(results, list(names))
    assert "named first, rightly" in printed
    assert "line_delay +1 2 s" in printed
