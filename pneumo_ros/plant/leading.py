"""Write the entry point that runs the states which follow from the inputs alone, without the rest of the machine."""

from typing import TYPE_CHECKING

from pneumo_ros.plant.entries import take, unpack
from pneumo_ros.plant.flow import FlowWriter
from pneumo_ros.plant.source import SourceBook
from pneumo_ros.plant.stepping import half_step, whole_step

if TYPE_CHECKING:
    from pneumo_ros.plant.compose import Resolver


def lead_texts(resolver: "Resolver", book: SourceBook, commanded: tuple[str, ...], names: list[str]) -> list[str]:
    """The inlined functions of these states, and the entry point `lead`; as `step` takes them, to the bit."""
    rates = [s for s in commanded if f"rate_{s}" in resolver.writers]
    arguments = [*resolver.states, *resolver.inputs, "t", *names]
    flow = FlowWriter(resolver, book)
    wanted = [f"der_{s}" for s in commanded] + [f"rate_{s}" for s in rates]
    slopes = [flow.value(w) if w in resolver.writers else "0.0" for w in wanted]
    after = FlowWriter(resolver, book)
    for effect in resolver.effects:
        if "advance" in effect.functions and set(effect.functions["advance"].writes) & set(commanded):
            after.advance(effect)
    return [
        _function("lead_derivatives", arguments, flow.lines, slopes),
        _function("lead_after", arguments, after.lines, list(commanded)),
        _entry(resolver, commanded, rates, names),
    ]


def _function(name: str, arguments: list[str], lines: list[str], returns: list[str]) -> str:
    body = "\n".join("    " + line for line in [*lines, f"return ({', '.join(returns)},)"])
    return f"@inline\ndef {name}({', '.join(arguments)}):\n{body}"


def _entry(resolver: "Resolver", commanded: tuple[str, ...], rates: list[str], names: list[str]) -> str:
    states = list(resolver.states)

    def called(function: str, suffix: str, time: str) -> str:
        own = [s + suffix if s in commanded else s for s in states]
        return f"{function}({', '.join([*own, *resolver.inputs, time, *names])})"

    slopes = ", ".join([f"d_{s}" for s in commanded] + [f"r_{s}" for s in rates]) + ","
    lines = [f"{slopes} = {called('lead_derivatives', '', 't')}", *(half_step(s, rates) for s in commanded)]
    lines += [f"{slopes} = {called('lead_derivatives', '_m', 't + half')}"]
    lines += [whole_step(s, rates, "relaxation") for s in commanded]
    lines += [f"{', '.join(commanded)}, = {called('lead_after', '_n', 't + h')}"]
    held = take(list(resolver.inputs), "k * parts + j")
    store = [f"out[i, {n}] = {s}" for n, s in enumerate(commanded)]
    return f'''@entry
def lead(x, q, inputs, t0, h, stride, parts, at, out):
    """Run {", ".join(commanded)} from x (states,) under `inputs`, as in `run`; out (instants, {len(commanded)}) at the
    beginning of the samples `at`, which ascend.
    """
{unpack(names, "q", "{0}")}
{unpack(states, "x", "{0}")}
    half, k = 0.5 * h, 0
    for i in range(at.shape[0]):
        for k in range(k, at[i]):
            for j in range(parts):
{_block(held, 4)}
                for s in range(stride):
                    t = t0 + ((k * parts + j) * stride + s) * h
{_block(lines, 5)}
        k = at[i]
{_block(store, 2)}'''


def _block(lines: list[str], depth: int) -> str:
    return "\n".join("    " * depth + line for line in lines)
