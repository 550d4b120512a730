"""Write the entry points that drive the effects along a measured motion: one run, and many lanes of parameters."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from pneumo_ros.plant.entries import LANES, take, unpack
from pneumo_ros.plant.library import is_part
from pneumo_ros.plant.stepping import evaluate, half_step, is_velocity, kick, whole_step

if TYPE_CHECKING:
    from pneumo_ros.plant.compose import Resolver


def _split(resolver: "Resolver", states: list[str]) -> tuple[list[str], list[str]]:
    """The frame's states, which are measured, and the effects' own."""
    own = [s for s in states if not is_part(resolver.states[s])]
    return [s for s in states if s not in own], own


def _indented(lines: list[str], depth: int) -> str:
    return "\n".join("    " * depth + line for line in lines)


def _step_lines(
    resolver: "Resolver", states: list[str], rates: list[str], names: list[str], ends: Callable[[int], tuple[str, str]]
) -> list[str]:
    """Lines of one step with inputs held from t on; `ends`: measured state i at the samples before and after it."""
    measured, own = _split(resolver, states)

    def between(suffix: str, share: str) -> list[str]:
        texts = [ends(i) for i in range(len(measured))]
        return [
            f"{s}{suffix} = {begin} + {share} * ({end} - {begin})"
            for s, (begin, end) in zip(measured, texts, strict=True)
        ]

    lines = ["half = 0.5 * h", *between("", "(s / steps)"), evaluate(resolver, rates, names, "", "t")]
    lines += [*between("_m", "((s + 0.5) / steps)"), *(half_step(s, rates) for s in own)]
    lines += [evaluate(resolver, rates, names, "_m", "t + half"), *between("_n", "((s + 1) / steps)")]
    lines += [f"mean_{s} += d_{s}" for s in states]
    swinging = [s for s in own if is_velocity(s, resolver)]
    if swinging:
        lines += kick(swinging, rates)
        lines.append(evaluate(resolver, rates, names, "_m", "t + half"))
    lines += [whole_step(s, rates, "relaxation") for s in own if s not in swinging]
    targets = ", ".join(s if s in own else "_" for s in states) + ","
    inputs = resolver.inputs
    return [*lines, f"{targets} = after_step({', '.join([*(s + '_n' for s in states), *inputs, 't + h', *names])})"]


def follow_text(resolver: "Resolver", states: list[str], rates: list[str], names: list[str]) -> str:
    """The entry point that drives the effects along a measured motion."""
    _, own = _split(resolver, states)
    lines = [*take(list(resolver.inputs), "k * parts + s // stride"), "t = t0 + (k * steps + s) * h"]
    lines += _step_lines(resolver, states, rates, names, lambda i: (f"X[k, {i}]", f"X[k + 1, {i}]"))
    load = [f"{s} = X[0, {states.index(s)}]" for s in own]
    clear = [f"mean_{s} = 0.0" for s in states]
    keep = [f"X[k + 1, {states.index(s)}] = {s}" for s in own]
    store = [f"out[k + 1, {i}] = mean_{s} / steps" for i, s in enumerate(states)]
    return f'''@entry
def follow(X, q, inputs, t0, h, stride, parts, out):
    """Advance the effects' own states along measured motion and pressures, interpolated between samples.

    X (samples, states): the frame's columns are given, the others are filled in from row 0 on; out (samples, states):
    mean derivatives over the interval that ends there, in which `parts` inputs are held for `stride` steps each.
    """
{unpack(names, "q", "{0}")}
{_indented(load, 1)}
    steps = stride * parts
    for k in range(X.shape[0] - 1):
{_indented(clear, 2)}
        for s in range(steps):
{_indented(lines, 3)}
{_indented(keep, 2)}
{_indented(store, 2)}'''


def follow_lanes_text(resolver: "Resolver", states: list[str], rates: list[str], names: list[str]) -> str:
    """The same for many lanes at once, and the function that advances one block of them."""
    measured, own = _split(resolver, states)
    n, m, width = len(states), len(measured), len(names)
    held = ", ".join(f"inputs[row, {i}]" for i in range(len(resolver.inputs)))

    def at(array: str, row: int) -> str:
        return f"{array}[{row * LANES} + i]"

    lines = [f"{name} = {at('c', row)}" for row, name in enumerate(names)]
    lines += [f"{s} = {at('x', states.index(s))}" for s in own]
    lines += [f"mean_{s} = {at('x', n + i)}" for i, s in enumerate(states)]
    lines += _step_lines(resolver, states, rates, names, lambda i: (at("x", i), at("c", width + i)))
    lines += [f"{at('x', states.index(s))} = {s}" for s in own]
    lines += [f"{at('x', n + i)} = mean_{s}" for i, s in enumerate(states)]
    return f'''@inline
def follow_block(x, c, {", ".join(resolver.inputs)}, t, h, s, steps):
    for i in range(LANES):
{_indented(lines, 2)}


@entry
def follow_lanes(measured, q, rest, inputs, t0, h, stride, parts, kept, X, wanted, out):
    """As `follow` for many lanes, each with its own parameters, in blocks of LANES.

    measured (lanes or 1, samples, {m}), q (lanes, parameters), rest (lanes, {n - m}); X (lanes, samples, kept): states
    whose indices `kept` holds; out (lanes, samples, wanted): mean derivatives, row 0 is left alone.
    """
    x, c = np.empty({2 * n * LANES}), np.empty({(width + m) * LANES})
    steps, lanes = stride * parts, q.shape[0]
    for b in range(0, lanes, LANES):
        filled = min(LANES, lanes - b)
        for i in range(LANES):
            lane = b + min(i, filled - 1)
            for j in range({width}):
                c[j * LANES + i] = q[lane, j]
            for j in range({m}):
                x[j * LANES + i] = measured[min(lane, measured.shape[0] - 1), 0, j]
            for j in range({n - m}):
                x[({m} + j) * LANES + i] = rest[lane, j]
        for i in range(filled):
            for j in range(kept.shape[0]):
                X[b + i, 0, j] = x[kept[j] * LANES + i]
        for k in range(measured.shape[1] - 1):
            for j in range({n * LANES}, {2 * n * LANES}):
                x[j] = 0.0
            for i in range(LANES):
                lane = min(b + min(i, filled - 1), measured.shape[0] - 1)
                for j in range({m}):
                    c[({width} + j) * LANES + i] = measured[lane, k + 1, j]
            for s in range(steps):
                row = k * parts + s // stride
                follow_block(x, c, {held}, t0 + (k * steps + s) * h, h, s, steps)
            for j in range({m * LANES}):  # to assign a slice would take two seconds to compile
                x[j] = c[{width * LANES} + j]
            for j in range({n * LANES}, {2 * n * LANES}):
                x[j] /= steps
            for i in range(filled):
                for j in range(kept.shape[0]):
                    X[b + i, k + 1, j] = x[kept[j] * LANES + i]
                for j in range(wanted.shape[0]):
                    out[b + i, k + 1, j] = x[({n} + wanted[j]) * LANES + i]'''
