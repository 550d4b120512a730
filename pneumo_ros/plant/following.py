"""Write the entry points that drive the effects along a measured motion: one run, and many lanes of parameters."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from pneumo_ros.plant import block_steps as steps
from pneumo_ros.plant.entries import LANES, take, unpack
from pneumo_ros.plant.flow import FlowWriter
from pneumo_ros.plant.library import is_part
from pneumo_ros.plant.source import SourceBook
from pneumo_ros.plant.staged import Block, in_order
from pneumo_ros.plant.stepping import evaluate, half_step, is_velocity, kick, whole_step

if TYPE_CHECKING:
    from pneumo_ros.plant.compose import Resolver


# Rows of variables of all states in a block: means of derivatives, the next sample, states at mid and end of a step,
# derivatives and rates
_ROWS = ("mean_{}", "end_{}", "{}_m", "{}_n", "d_{}", "r_{}")


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


def follow_lanes_text(
    resolver: "Resolver", book: SourceBook, states: list[str], rates: list[str], names: list[str]
) -> str:
    """The same for many lanes at once, with the functions that work on one block of them (see `staged`)."""
    measured, own = _split(resolver, states)
    inputs, n, m = list(resolver.inputs), len(states), len(measured)
    block = Block(resolver.effects, states, [*inputs, "t"])
    rows = {"q": names, "x": states} | {key: [key.format(s) for s in states] for key in _ROWS}
    at = {key: LANES * min(block.place(name) for name in row) for key, row in rows.items()}
    evaluation, advance = _evaluation(resolver, book, block, rates), _advance(resolver, book, block)
    texts = [_block_function("evaluate_block", inputs, evaluation)]
    texts += [_block_function("advance_block", inputs, advance)] if advance else []
    owners = [resolver.states[s].name if s in own else "" for s in states]
    switches = [block.switches.index(owner) if owner in block.switches else -1 for owner in owners]
    swings = [s in own and is_velocity(s, resolver) for s in states]
    clear = [f"put(cells, {LANES * block.place(name)}, i, {value})" for name, value in block.idle.items()]
    held = ", ".join(f"inputs[row, {i}]" for i in range(len(inputs)))
    step = _block_step(resolver, book, at, n, m, any(swings), bool(advance))
    texts.append(f'''@entry
def follow_lanes(measured, q, rest, inputs, acting, t0, h, stride, parts, kept, X, wanted, out):
    """As `follow` for many lanes, each with its own parameters, in blocks of LANES.

    measured (lanes or 1, samples, {m}), q (lanes, parameters), rest (lanes, {n - m}); acting (blocks, effects): whether
    any lane of a block has {", ".join(block.switches)}; X (lanes, samples, kept): states whose indices `kept` holds;
    out (lanes, samples, wanted): mean derivatives, row 0 is left alone.
    """
    cells, moves, swings = np.zeros({LANES * len(block)}), np.empty({n}, np.bool_), np.array({swings})
    switches = np.array({switches})
    steps, lanes, half = stride * parts, q.shape[0], 0.5 * h
    for b in range(0, lanes, LANES):
        filled, some = min(LANES, lanes - b), acting[b // LANES]
        width, swinging = min((filled + 3) // 4 * 4, LANES), False  # whole vectors
        for k in range({n}):
            moves[k] = switches[k] < 0 or some[switches[k]]
            swinging = swinging or (moves[k] and swings[k])
        for i in range(width):
            lane = b + min(i, filled - 1)
            for j in range({len(names)}):
                cells[j * LANES + i] = q[lane, j]
            for j in range({m}):
                cells[{at["x"]} + j * LANES + i] = measured[min(lane, measured.shape[0] - 1), 0, j]
            for j in range({n - m}):
                cells[{at["x"] + m * LANES} + j * LANES + i] = rest[lane, j]
                cells[{at["{}_m"] + m * LANES} + j * LANES + i] = rest[lane, j]
        for i in range(width):
{_indented(clear, 3)}
        for i in range(filled):
            for j in range(kept.shape[0]):
                X[b + i, 0, j] = cells[{at["x"]} + kept[j] * LANES + i]
        for k in range(measured.shape[1] - 1):
            for j in range({n * LANES}):
                cells[{at["mean_{}"]} + j] = 0.0
            for i in range(width):
                lane = min(b + min(i, filled - 1), measured.shape[0] - 1)
                for j in range({m}):
                    cells[{at["end_{}"]} + j * LANES + i] = measured[lane, k + 1, j]
            for s in range(steps):
                row, t = k * parts + s // stride, t0 + (k * steps + s) * h
{_indented([line.format(held=held) for line in step], 4)}
            for j in range({m * LANES}):  # to assign a slice would take two seconds to compile
                cells[{at["x"]} + j] = cells[{at["end_{}"]} + j]
            for i in range(filled):
                for j in range(kept.shape[0]):
                    X[b + i, k + 1, j] = cells[{at["x"]} + kept[j] * LANES + i]
                for j in range(wanted.shape[0]):
                    out[b + i, k + 1, j] = cells[{at["mean_{}"]} + wanted[j] * LANES + i] / steps''')
    return "\n\n\n".join(texts)


def _block_function(name: str, inputs: list[str], lines: list[str]) -> str:
    return f"@block\ndef {name}(cells, width, acting, {', '.join(inputs)}, t):\n{_indented(lines, 1)}"


def _evaluation(resolver: "Resolver", book: SourceBook, block: Block, rates: list[str]) -> list[str]:
    """Lines that evaluate all derivatives of a block at its states `_m`."""
    flow = FlowWriter(resolver, book)
    for s in resolver.states:
        for name, made in ((f"d_{s}", f"der_{s}"), (f"r_{s}", f"rate_{s}")):
            if made in resolver.writers and (name[0] == "d" or s in rates):
                block.same(flow.value(made), name)
            else:
                block.idle[name] = 0.0
    return block.stages(in_order(flow.written), "_m")


def _advance(resolver: "Resolver", book: SourceBook, block: Block) -> list[str]:
    """Lines that advance what moves once a step, from the states `_n` of a block."""
    flow = FlowWriter(resolver, book)
    for effect in resolver.effects:
        if "advance" in effect.functions:
            flow.advance(effect)
    return block.stages(flow.written, "_n")


def _block_step(
    resolver: "Resolver", book: SourceBook, at: dict[str, int], n: int, m: int, kicked: bool, advanced: bool
) -> list[str]:
    """Lines of one step of a block, as `_step_lines` of one lane; "{held}" stands for the inputs."""
    x, middle, after, slope, rate = (at[key] for key in ("x", "{}_m", "{}_n", "d_{}", "r_{}"))
    mean, end = at["mean_{}"], at["end_{}"]

    def call(function: Callable[..., None], *arguments: object) -> str:
        return f"{book.helper(function, 'the integrator')}(cells, width, {', '.join(map(str, arguments))})"

    def measured_at(to: int, share: str) -> str:
        return call(steps.interpolate, to, x, end, m, share)

    def evaluated(time: str) -> str:
        return f"evaluate_block(cells, width, some, {{held}}, {time})"

    whole = ("moves", "swings", m, n, after, middle, x, slope, rate, "h")
    lines = [measured_at(middle, "s / steps"), evaluated("t"), measured_at(middle, "(s + 0.5) / steps")]
    lines += [call(steps.half_steps, "moves", m, n, middle, x, slope, rate, "half"), evaluated("t + half")]
    lines += [measured_at(after, "(s + 1) / steps"), call(steps.add, "moves", m, n, mean, slope)]
    if kicked:
        lines += ["if swinging:", f"    {call(steps.kicks, *whole)}", f"    {evaluated('t + half')}"]
    lines.append(call(steps.whole_steps, *whole))
    lines += ["advance_block(cells, width, some, {held}, t + h)"] if advanced else []
    return [*lines, call(steps.copy, "moves", m, n, x, middle, after)]
