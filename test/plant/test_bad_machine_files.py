"""Bad machine files: each error gives the fault, its place and the nearest names; nothing is loaded or run."""

from pathlib import Path

import pytest

from pneumo_ros.errors import DataError, PneumoError, UsageError
from pneumo_ros.plant import load_model
from pneumo_ros.plant.machine_file import machine_text, shipped_machines

NAMES = ", ".join(shipped_machines())
TEXT = machine_text(load_model("axis"))


def written(folder: Path, text: str | bytes) -> Path:
    """A machine file of that content."""
    path = folder / "machine.yaml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{name}: &{name} [{', '.join(['*' + before] * 9)}]\n" for before, name in zip("abcdefgh", "bcdefghi", strict=True)
)
CHOKED_ALONE = """/**:
  ros__parameters:
    effects: [dead_zone, choked_flow]
    chambers: {volume_a: 5.1e-4}
"""
BAD = {  # fault: file, text of the error
    "unknown effect": (TEXT.replace("dead_zone", "deadzone"), r"unknown effect 'deadzone'; did you mean dead_zone"),
    "effect twice": (TEXT.replace("[dead_zone,", "[dead_zone, dead_zone,"), r"dead_zone is listed twice"),
    "unknown section": (TEXT.replace("    air:", "    aer:"), r"unknown section 'aer'; did you mean air"),
    "section not listed": (TEXT.replace("dead_zone, ", ""), r"unknown section 'dead_zone'.*add it to 'effects'"),
    "unknown parameter": (TEXT.replace("mass:", "mas:"), r"unknown parameter 'piston.mas'; did you mean piston.mass"),
    "missing parameter": (
        TEXT.replace("      mass: 5.0  #", "      #"),
        r"parameter piston.mass is missing; add to the sections .*:\n    piston:\n      mass: 5.0  # \[kg\]",
    ),
    "missing parameters": (
        TEXT.replace("      mass: 5.0  #", "      #").replace("      stiffness:", "      #"),
        r"2 parameters are missing; add (?s:.*)piston:\n      mass: 5.0(?s:.*)end_stop:\n      stiffness: ",
    ),
    "missing section": (
        TEXT[: TEXT.index("    end_stop:")],
        r"2 parameters are missing; add (?s:.*)    end_stop:\n      stiffness: (?s:.*)\n      damping: ",
    ),
    "an effect without the one it works beside": (
        TEXT.replace("[dead_zone, arctan_flow,", "[dead_zone, choked_flow,"),
        r"unknown section 'arctan_flow'.*add it to 'effects' if you want it",
    ),
    "an effect without the one it works beside, nor its section": (
        CHOKED_ALONE,
        r"choked_flow needs effect arctan_flow \(it reads filling_coefficient\); add arctan_flow to",
    ),
    "an effect without the section it reads": (
        "/**:\n  ros__parameters:\n    effects: [arctan_flow]\n    piston: {mass: 5.0}\n",
        r"arctan_flow needs section 'chambers' \(it reads p_a\); add section 'chambers' with volume_a, volume_b",
    ),
    "out of range": (TEXT.replace("mass: 5.0", "mass: -5.0"), r"piston.mass is -5.0 kg; allowed is 0.001 to 10000"),
    "not a number": (TEXT.replace("mass: 5.0", "mass: .nan"), r"piston.mass is nan kg"),
    "infinite": (TEXT.replace("mass: 5.0", "mass: .inf"), r"piston.mass is inf kg"),
    "infinite as text": (TEXT.replace("mass: 5.0", "mass: 1e999"), r"piston.mass is inf kg"),
    "huge": (TEXT.replace("mass: 5.0", "mass: " + "9" * 400), r"piston.mass is 9+\.\.\.9+ kg"),
    "text": (TEXT.replace("mass: 5.0", "mass: five"), r"piston.mass is 'five'; it takes a number in kg"),
    "list": (TEXT.replace("mass: 5.0", "mass: [5.0]"), r"piston.mass is \[5.0\]"),
    "date": (TEXT.replace("mass: 5.0", "mass: 2020-01-01"), r"piston.mass is datetime"),
    "true": (TEXT.replace("mass: 5.0", "mass: yes"), r"piston.mass is True"),
    "nothing": (TEXT.replace("mass: 5.0", "mass:"), r"piston.mass is None"),
    "twice": (TEXT.replace("mass: 5.0", "mass: 5.0\n      mass: 6.0"), r"line 5.*mass is given twice"),
    "section twice": (TEXT + TEXT[TEXT.index("    end_stop:") :], r"end_stop is given twice"),
    "section a number": (TEXT + "    rod_atmospheric_force: 5\n", r"section rod_atmospheric_force is 5"),
    "effects a text": (TEXT.replace("[dead_zone,", "dead_zone #"), r"'effects' is 'dead_zone'; it takes a list"),
    "effects of numbers": (TEXT.replace("[dead_zone,", "[1,"), r"'effects' is \[1,"),
    "no effects": (TEXT.replace("    effects:", "    #"), r"'effects' is None"),
    "other node": (TEXT.replace("/**:", "controller:").replace("effects:", "law:"), r"no section '/\*\*'"),
    "no ros__parameters": (TEXT.replace("ros__parameters", "parameters"), r"no section 'ros__parameters'"),
    "a list": ("- 1\n- 2\n", r"no section"),
    "empty": ("", r"no section"),
    "no YAML": ("/**: [", r"cannot be read as YAML at line 1"),
    "tabs": (TEXT.replace("      mass", "\t\tmass"), r"cannot be read as YAML at line 5"),
    "deeply nested": ("[" * 3000, r"cannot be read as YAML"),
    "Python object": (
        TEXT.replace("mass: 5.0", "mass: !!python/object/apply:os.system ['touch {marker}']"),
        r"cannot be read as YAML at line 5: could not determine a constructor",
    ),
    "bomb in effects": (BOMB + TEXT.replace("[dead_zone,", "[*i,"), r"'effects' is \["),
    "bomb as a value": (BOMB + TEXT.replace("mass: 5.0", "mass: *i"), r"piston.mass is \["),
    "bomb as a section": (BOMB + TEXT + "    rod_atmospheric_force: *i\n", r"section rod_atmospheric_force is \["),
    "zero bytes": (b"\x00" + TEXT.encode(), r"cannot be read as YAML"),
}


@pytest.mark.parametrize("wrong", BAD)
def test_bad_files_load_nothing_and_say_why(tmp_path: Path, wrong: str) -> None:
    content, sentence = BAD[wrong]
    marker = tmp_path / "executed"
    content = content.replace("{marker}", str(marker)) if isinstance(content, str) else content
    path = written(tmp_path, content)
    with pytest.raises(UsageError, match=sentence) as caught:
        load_model(path)
    assert str(path) in str(caught.value)
    assert len(str(caught.value)) < 2000
    assert not marker.exists()


@pytest.mark.parametrize("content", [b"\xff\xfe\x00\x01", bytes(range(128, 256)), None])
def test_files_that_hold_no_text_are_reported(tmp_path: Path, content: bytes | None) -> None:
    path = tmp_path if content is None else written(tmp_path, content)
    with pytest.raises(DataError, match=rf"cannot be read.*one of: {NAMES}"):
        load_model(path)


@pytest.mark.parametrize("name", ["axes", "", "/nowhere/axis.yaml", "a\x00b"])
def test_unknown_machines_are_reported_with_the_known_ones(name: str) -> None:
    with pytest.raises(DataError, match=rf"one of: {NAMES}"):
        load_model(name)


def test_loading_again_after_an_error_gives_the_whole_model(tmp_path: Path) -> None:
    path = written(tmp_path, TEXT.replace("damping: 5.0", "damping: -5.0"))
    with pytest.raises(PneumoError):
        load_model(path)
    path.write_text(TEXT)
    assert load_model(path).values.tobytes() == load_model("axis").values.tobytes()
