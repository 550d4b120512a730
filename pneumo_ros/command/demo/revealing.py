"""Whether a diagnosis is right, once the truth is known."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

LARGEST_GROUP = 3  # effects that a right answer may leave open

EXACT, GROUP, VAGUE, MISSED, FALSE, WRONG = "exact", "group", "vague", "missed", "false addition", "wrong"
Addition = tuple[str, Sequence[str]]  # an effect that was added, and its rivals, which explain as much


@dataclass(frozen=True)
class Judgement:
    """Names of hidden effects by how they were found, and of added ones that are not there.

    exact: added, with no rival. grouped: added or a rival, in a group of at most LARGEST_GROUP. vague:
    in a larger group. missed: in no group. false: added, but neither hidden nor in a group with a hidden effect.
    """

    exact: tuple[str, ...] = ()
    grouped: tuple[str, ...] = ()
    vague: tuple[str, ...] = ()
    missed: tuple[str, ...] = ()
    false: tuple[str, ...] = ()

    @property
    def word(self) -> str:
        """The judgement in one word, the worst that applies; also "exact" where nothing was hidden or added."""
        if self.false:
            return WRONG if self.missed or self.vague else FALSE
        for names, word in ((self.missed, MISSED), (self.vague, VAGUE), (self.grouped, GROUP)):
            if names:
                return word
        return EXACT

    @property
    def right(self) -> bool:
        """Whether every hidden effect was named, or left open among few, and nothing else was added."""
        return self.word in (EXACT, GROUP)

    def sentence(self) -> str:
        """The judgement as a sentence."""
        said = {
            EXACT: "The diagnosis is right.",
            GROUP: f"The diagnosis is right: it leaves {_listed(self.grouped)} open among at most {LARGEST_GROUP}.",
            VAGUE: f"The diagnosis says too little: {_listed(self.vague)} is one of many that it cannot distinguish.",
            MISSED: f"The diagnosis is wrong: it missed {_listed(self.missed)}.",
            FALSE: f"The diagnosis is half right: it also added {_listed(self.false)}, which is not there.",
        }
        missed, false = _listed((*self.missed, *self.vague)), _listed(self.false)
        return said.get(self.word, f"The diagnosis is wrong: it was {missed}, and it added {false}.")


def _listed(names: Sequence[str]) -> str:
    return " and ".join(names)


def pairing(hidden: Sequence[str], added: Sequence[Addition]) -> dict[str, int]:
    """For each hidden effect that was found, the place in `added` of the addition that found it, by name first."""
    return max((_pairing(order, added) for order in permutations(hidden)), key=len)


def _pairing(hidden: Sequence[str], added: Sequence[Addition]) -> dict[str, int]:
    found: dict[str, int] = {}
    for by_name in (True, False):
        for name in hidden:
            for place, (effect, rivals) in enumerate(added):
                hit = name == effect if by_name else name in rivals
                if hit and name not in found and place not in found.values():
                    found[name] = place
    return found


def judge(hidden: Sequence[str], added: Sequence[Addition]) -> Judgement:
    """Compare catalogue names of hidden effects with what was added."""
    found = pairing(hidden, added)
    kinds: dict[str, list[str]] = {EXACT: [], GROUP: [], VAGUE: [], MISSED: []}
    for name in hidden:
        kinds[_kind(added[found[name]]) if name in found else MISSED].append(name)
    false = [effect for place, (effect, _) in enumerate(added) if place not in found.values()]
    exact, grouped, vague, missed = (tuple(names) for names in kinds.values())
    return Judgement(exact, grouped, vague, missed, tuple(false))


def _kind(addition: Addition) -> str:
    rivals = addition[1]
    if not rivals:
        return EXACT
    return GROUP if 1 + len(rivals) <= LARGEST_GROUP else VAGUE
