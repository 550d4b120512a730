"""Assumptions of the benchmarks about the tree."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pneumo_ros.plant import Model, load_model
from pneumo_ros.runs.run import PARTS, Run

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


def test_decisions_are_made_anew_with_numbers_halved_and_doubled(monkeypatch: pytest.MonkeyPatch) -> None:
    """A leak of 12 nats is added, not if 16 are asked; a delay of 1.5 samples, not if two are; a droop never was."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import blind_numbers

    def measured(effect: str, **values: Any) -> dict[str, Any]:
        usual = {"train": 30.0, "heldout": 10.0, "size": 1.0, "share": 0.9, "first": True, "known": 0.0, "pays": 0.0}
        return {**usual, "contained": False, "lag": np.inf, "swing": np.inf, "refused": "", "effect": effect, **values}

    leak, late = measured("leak", train=7.0, heldout=5.0), measured("late", lag=1.5)
    results = [
        {"decisions": [[leak], [measured("late", refused="it does not pay")]]},
        {"decisions": [[late, measured("leak")]]},
        {"decisions": [[measured("droop", heldout=-1.0)]]},
    ]
    assert [blind_numbers.chosen(one) for one in results[0]["decisions"]] == ["leak", ""]
    rows = [line.split() for line in blind_numbers.table(results).splitlines()[1:]]
    counts = {(row[0], row[2 if row[0] != "SHARE_LEAST" else 4]): row for row in rows}
    assert {key: "1/4" in row for key, row in counts.items()} == {
        (name, factor): (name, factor) in {("MARGIN", "2"), ("RESOLVED", "2")}
        for name in blind_numbers.NUMBERS
        for factor in ("0.5", "2")
    }


def test_each_kind_of_blind_case_may_have_a_number_of_seeds_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import bench_blind

    def cases(*options: str) -> list[tuple[str, int]]:
        monkeypatch.setattr("sys.argv", ["bench_blind.py", *options])
        return [(kind, seed) for kind, seed, *_ in bench_blind.wanted(bench_blind.arguments())]

    assert cases("--kind", "single=3,healthy=1", "--first-seed", "7") == [
        ("single", 7), ("healthy", 7), ("single", 8), ("single", 9),
    ]  # fmt: skip
    assert cases("--kind", "pair", "--seeds", "2") == [("pair", 0), ("pair", 1)]
    assert len(cases("--seeds", "2")) == 2 * len(bench_blind.KINDS)
    for wrong in ("twin", "single=", "single=2,twin=1"):
        with pytest.raises(SystemExit):
            cases("--kind", wrong)


def test_every_effect_that_shows_in_motion_has_a_term_in_the_library_of_pysindy(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An effect without a term could never be named, which would say nothing about the method."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    from peer_terms import TERMS

    from pneumo_ros.diagnose.hypothesis import missing
    from pneumo_ros.plant import load_model

    named = {term.effect for term in TERMS}
    assert set(missing(load_model("axis"), ("U",))) - named == {"dwell_time_breakaway"}  # it acts at rest
    assert named <= set(missing(load_model("axis"), ("U",)))


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


def test_a_missed_effect_is_said_where_the_diagnosis_says_that_it_cannot_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import blind_tables

    hidden = [{"effect": name, "in_catalogue": True} for name in ("constant_load", "valve_internal_leakage")]
    load = {"effect": "constant_load", "group": []}
    one = {"kind": "pair", "strength": 0.5, "hidden": hidden, "added": [load]}
    said = {**one, "cannot_say": ["valve_internal_leakage"]}
    false = {**said, "added": [load, {"effect": "backlash", "group": []}]}
    right = {**one, "added": [load, {"effect": "valve_internal_leakage", "group": []}]}
    results = [one, said, false, right]
    judged = [blind_tables.judgement(result) for result in results]
    told = [blind_tables.right_or_said(*pair) for pair in zip(results, judged, strict=True)]
    assert told == [False, True, False, True]
    assert blind_tables.rates_table(results).splitlines()[1].split("   (target")[0].endswith("2/4 50 % (15-85)")


SIDED = (
    "valve_null_offset", "leakage_to_atmosphere", "dead_volume", "spring_load", "constant_load", "choked_flow",
    "asymmetric_viscous_friction", "position_dependent_friction", "supply_pressure_droop", "valve_internal_leakage",
)  # fmt: skip
VALUES = {"position_dependent_friction.knot_09": 0.3, "leakage_to_atmosphere.conductance_b": 4e-10}


def moved(model: Model, sign: float = 1.0, pressures: tuple[float, float] = (2e5, 2.5e5)) -> Any:
    """Position and both pressures (samples, 3) under a voltage that changes direction."""
    volts = sign * 2.0 * np.sign(np.sin(np.arange(1500) * 4e-3))
    state = model.state(y=sign * 0.1, p_a=pressures[0], p_b=pressures[1])
    return model.simulate(volts, state)[:, [model.states.index(name) for name in ("y", "p_a", "p_b")]]


@pytest.fixture(scope="module")
def sided() -> Model:
    """A machine whose effects tell left from right, and small from large."""
    model = load_model("axis")
    return model.with_effects([*model.effects, *SIDED], VALUES)


def test_a_mirrored_machine_moves_the_other_way(sided: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    from invariance_machines import mirrored_model

    here, there = moved(sided), moved(mirrored_model(sided), -1.0, (2.5e5, 2e5))
    assert np.ptp(here[:, 0]) > 0.05
    assert there[:, [0, 2, 1]] * [-1.0, 1.0, 1.0] == pytest.approx(here, rel=1e-6)


@pytest.mark.parametrize(("area", "pressure"), [(2.0, 1.0), (1.0, 2.0)])
def test_a_scaled_machine_moves_alike(
    sided: Model, area: float, pressure: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    from invariance_machines import scaled_model

    larger = moved(scaled_model(sided, area, pressure), pressures=(2e5 * pressure, 2.5e5 * pressure))
    assert larger / [1.0, pressure, pressure] == pytest.approx(moved(sided), rel=1e-6)


def test_pieces_hold_the_whole_recording(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    from invariance_changes import Question, pieces

    position, held = np.arange(9.0), np.arange(8.0 * PARTS)
    run = Run("long", 1e-3, position, -position, 2.0 * position, held, position > 2.0, False)
    first, second = pieces(Question(load_model("axis"), [run], [])).train
    assert [len(first), len(second)] == [4, 5]
    for name in ("position", "pressure_a", "pressure_b", "measured"):
        assert np.array_equal(np.concatenate([getattr(first, name), getattr(second, name)]), getattr(run, name))
    assert np.array_equal(first.input, held[: 3 * PARTS])
    assert np.array_equal(second.input, held[4 * PARTS :])


def test_a_rival_is_the_same_answer_and_another_verdict_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    from invariance_tables import same_answer, table

    def result(change: str, verdict: str, *added: tuple[str, list[str], float]) -> dict[str, Any]:
        effects = [{"effect": name, "group": group, "parameters": {"k": (size, 0.1)}} for name, group, size in added]
        return {"seed": 3, "change": change, "verdict": verdict, "added": effects, "hidden": ["spring_load"]}

    before = result("as recorded", "effects_found", ("spring_load", ["constant_load"], 1.0), ("backlash", [], 2.0))
    after = result("pieces", "effects_found", ("backlash", [], 2.5), ("constant_load", [], 9.0))
    other = result("mirrored", "unknown_effect", ("spring_load", [], 1.1), ("backlash", [], 2.0))
    assert same_answer(before, after)
    assert not same_answer(before, other)
    assert not same_answer(before, result("larger", "effects_found", ("spring_load", [], 1.0)))
    text = table([before, after, other])
    assert re.search(r"^pieces +1/1 .* 0/1 ", text, re.MULTILINE)
    assert re.search(r"^mirrored +0/1 .* 2/2 .* 3$", text, re.MULTILINE)
    assert "[3 'mirrored'] spring_load: effects_found, " in text
    assert "backlash.k by 1.8 intervals" in text
