"""The rig of a live node: how it is wired, which signal closes its valve, and whether anybody has said so.

A valve of 0 to 10 V that gets 0 V is wide open. A node that commands a valve therefore sends nothing until a file, a
parameter, or a simulator in the role of the rig says which signal closes it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from pneumo_ros.axis.setting import Setting
from pneumo_ros.errors import UsageError
from pneumo_ros.reading.rig_file import NULL_OFFSET, VOLTS, Rig, quantity, read_rig, with_closed
from pneumo_ros.records.corrections import Wiring, parse_words, wiring

SETTINGS = (
    Setting("rig", "", "rig file: machine, wiring and limits, as pneumo rig check writes it", live=False),
    Setting("read_as", "", "the wiring, in place of the rig file's: words such as mm,reversed-voltage", live=False),
    Setting("closed_signal", "", "command that closes the valve, such as 0V or 5V; none: as the files say", "V",
            live=False),
)  # fmt: skip
UNDECLARED = (
    "nothing says which signal closes the valve, and no simulator plays the rig, so no command is sent: a valve of "
    "0 to 10 V is wide open at 0 V. Look into its data sheet and add {parameter} (5V for a valve of 0 to 10 V), or a "
    "rig file with the line 'closed: 0V' ({rig}), or a machine file with the effect valve_null_offset or dead_zone"
)
OTHERWISE = (
    "the simulator closes its valve at {plant:g} V, and this node would close it at {own:g} V, so no command is sent: "
    "start it with the simulator's machine file (--params-file), or add -p closed_signal:={plant:g}V"
)
AS_PARAMETER = UNDECLARED.format(parameter="-p closed_signal:=0V", rig="-p rig:=rig.yaml")
AS_OPTION = UNDECLARED.format(parameter="--closed 0V", rig="--rig rig.yaml")  # for a node that a verb has started


@dataclass(frozen=True)
class LiveRig:
    """Voltages [V] as the valve gets them; `declared`: whether somebody said which signal closes it."""

    wiring: Wiring
    rig: Rig
    declared: bool

    def command(self, volts: float) -> float:
        """The command [V] for `volts` at the machine's valve, within the range of the rig's valve."""
        sent = self.wiring.command(volts)
        return sent if self.rig.range is None else min(max(sent, self.rig.range[0]), self.rig.range[1])

    def safe(self, closed: float) -> float:
        """The command [V] while measurements are missing, and at the end; `closed` [V] closes the machine's valve."""
        return self.command(closed) if self.rig.safe is None else self.rig.safe

    def refusal(self, closed: float, simulated: float | None, *, verb: bool = False) -> str:
        """Why no command may be sent; empty if one may. `simulated` [V] closes the valve of a simulated rig, if any.

        `verb`: the reader has typed a verb, not the command of a node.
        """
        if self.declared:
            return ""
        if simulated is None:
            return AS_OPTION if verb else AS_PARAMETER
        own = self.wiring.command(closed)
        return OTHERWISE.format(plant=simulated, own=own) if abs(own - simulated) > NULL_OFFSET else ""

    def room(self, closed: float, most: float) -> float:
        """Volts on either side of the closed signal, for commands up to `most` [V]."""
        low, high = self.rig.range or (-most, most)
        sent = self.wiring.command(closed)
        return min(min(high, most) - sent, sent - max(low, -most))


def live_rig(values: Mapping[str, Any], closed: float, said: bool) -> LiveRig:
    """The rig that the parameters of a node describe.

    `closed` [V]: the signal that closes the valve by the machine file, if it `said` one. Raises UsageError where two of
    file, words and parameter contradict each other.
    """
    rig = rig_of(values)
    words = parse_words(values["read_as"] or rig.read_as)
    named = rig.closed
    if values["closed_signal"]:
        named = quantity(values["closed_signal"], VOLTS, "closed_signal", "5V")
        if rig.closed is not None and rig.closed != named:
            raise UsageError(f"closed_signal is {named:g} V, and rig {values['rig']} says closed {rig.closed:g} V")
    declared = said or named is not None or any(word.startswith("closed=") for word in words)
    return LiveRig(wiring(with_closed(words, named, closed)), rig, declared)


def rig_of(values: Mapping[str, Any]) -> Rig:
    """The rig file that the parameters name; an empty one where they name none."""
    return _read(values["rig"]) if values["rig"] else Rig()


_read = lru_cache(maxsize=4)(read_rig)  # parameters are checked at every change


def recorded_as(values: Mapping[str, Any], closed: float) -> tuple[str, ...]:
    """Words of --read-as for recordings of the rig; `closed` [V] closes the valve by the machine file."""
    rig = rig_of(values)
    return with_closed(parse_words(values["read_as"] or rig.read_as), rig.closed, closed)
