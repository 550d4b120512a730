"""A commissioning as text: the wiring, the parameters with their intervals, what was gained and what lacks."""

from typing import TYPE_CHECKING, Any

from pneumo_ros.command.console import columns
from pneumo_ros.compare.wording import number
from pneumo_ros.wording.commissioning import another_minute, times, value_and_interval
from pneumo_ros.wording.naming import listed

if TYPE_CHECKING:
    from pneumo_ros.commission.wiring import Wired

ENOUGH = 3.0  # times the noise, beyond which a machine has more to it than its file says


def wiring_text(wired: "Wired") -> str:
    """How the rig is wired, and what to mend."""
    plain = [word for word in wired.words if word not in wired.faults]
    said = f"Wiring: {', '.join(plain) or 'SI units, absolute pressures, zero at mid stroke'}"
    lines = [f"{said}; {'no plug is wrong' if not wired.faults else 'something is swapped or reversed'}."]
    lines += [f"  {word}: {how}" for word, how in wired.faults.items()]
    if not wired.certain:
        lines.append(
            "  This is not certain: another wiring explains the moves nearly as well. Does the rod extend while the "
            "position rises? Say what is known with --read-as, such as --read-as gauge,bar"
        )
    return "\n".join(lines)


def parameters_text(result: dict[str, Any]) -> str:
    """The table of parameters; `result` is the verb's JSON."""
    rows = [("", "data sheet", "found", "95 % interval", "unit")]
    for name, one in result["parameters"].items():
        rows.append((name, number(one["before"], 4), *value_and_interval(one, "-"), one["unit"]))
    return columns(rows, right=(1, 2))


def outcome_text(result: dict[str, Any]) -> str:
    """What was gained, what another minute would gain, and what lacks."""
    error, seconds = result["error_over_noise"], result["seconds"]
    said = [
        f"{len(result['moves'])} programmes, {seconds:.0f} s of moves. Predicted over 1 s, the position is off by "
        f"{times(error['before'])} its noise with the data sheets' machine, and by {times(error['after'])} its noise "
        "with this one.",
        another_minute(result),
    ]
    if result["undetermined"]:
        said.append(f"Not determined by these moves: {listed(result['undetermined'])}.")
    if error["after"] is None or error["after"] > ENOUGH:
        said.append(
            "That is more than noise: friction at rest is not known well yet, or the machine has effects that its file "
            "lacks. A diagnosis tells."
        )
    return "\n".join(said)
