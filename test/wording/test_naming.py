"""Numbers with their uncertainty, and names within sentences."""

from pneumo_ros.wording.naming import change, interval, listed, resolved, the


def test_numbers_have_the_decimals_that_their_uncertainty_leaves() -> None:
    assert (resolved(115.0561, 0.276), interval(115.0561, 0.276)) == ("115.1", "114.5 to 115.6")
    assert interval(0.0, 8.6e-5, least=0.0) == "0.00000 to 0.00017"
    assert (resolved(2.04e-11, 3e-13), interval(2.04e-11, 3e-13)) == ("2.04e-11", "1.98e-11 to 2.1e-11")
    assert interval(3.0, float("inf")) == "not determined"
    assert change(9.1, 1.02) == "-89 %"
    assert (change(1.0, 1.004), change(1.0, 72.0), change(0.0, 1.0)) == ("no change", "72 times as much", "")


def test_names_are_listed_as_people_list_them() -> None:
    assert [listed(["a", "b", "c"][:n]) for n in range(4)] == ["nothing", "a", "a and b", "a, b and c"]
    assert listed(["a", "b"], "or") == "a or b"
    assert [the(n) for n in ("momentum", "chamber_a", "valve")] == [
        "the momentum equation", "the equation of chamber a", "the valve",
    ]  # fmt: skip
