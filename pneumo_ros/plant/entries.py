"""Write the compiled entry points of a kernel: each loops over samples and calls what is inlined into it."""

from typing import TYPE_CHECKING

from pneumo_ros.plant.library import FRAME
from pneumo_ros.plant.stepping import evaluate, half_step, is_velocity, kick, whole_step

if TYPE_CHECKING:
    from pneumo_ros.plant.compose import Resolver

LANES = 16  # parameter sets that advance together; a multiple of every SIMD width


def _unpack(names: list[str], array: str, index: str) -> str:
    return "\n".join(f"    {name} = {array}[{index.format(i)}]" for i, name in enumerate(names))


def run_text(states: list[str], names: list[str]) -> str:
    """The entry point of single runs."""
    targets = ", ".join(states) + ","
    store = "\n".join(f"        out[k, {i}] = {s}" for i, s in enumerate(states))
    final = "\n".join(f"    x[{i}] = {s}" for i, s in enumerate(states))
    return f'''@entry
def run(x, q, voltage, t0, h, stride, parts, out):
    """Advance x (states,); out (samples, states) after each sample of `parts` held voltages of `stride` steps each."""
{_unpack(names, "q", "{0}")}
{_unpack(states, "x", "{0}")}
    for k in range(out.shape[0]):
        for j in range(parts):
            U = voltage[k * parts + j]
            for s in range(stride):
                t = t0 + ((k * parts + j) * stride + s) * h
                {targets} = step({", ".join([*states, "U", "t", "h", *names])})
{store}
{final}'''


def lanes_text(states: list[str], names: list[str]) -> str:
    """The entry point of many lanes at once, and what advances one block of them."""
    arguments = [f"x[{i * LANES} + i]" for i in range(len(states))] + ["u[i]", "t[i] + elapsed", "h"]
    arguments += [f"q[{i * LANES} + i]" for i in range(len(names))]
    targets = ", ".join(states) + ","
    store = "\n".join(f"        x[{i * LANES} + i] = {s}" for i, s in enumerate(states))
    return f'''@inline
def step_lanes(x, q, u, t, elapsed, h):
    for i in range(LANES):
        {targets} = step({", ".join(arguments)})
{store}


@entry
def run_lanes(x, q, voltage, first, t0, h, stride, parts, out):
    """Advance blocks of LANES independent lanes.

    x (blocks, states * LANES), q (blocks, parameters * LANES), first (blocks, LANES): index of each lane's first entry
    in `voltage`, t0 (blocks, LANES), out (blocks, samples, states * LANES); samples as in `run`.
    """
    u = np.empty(LANES)
    for b in range(x.shape[0]):
        x_b, q_b, t_b = x[b], q[b], t0[b]
        for k in range(out.shape[1]):
            for j in range(parts):
                for i in range(LANES):
                    u[i] = voltage[first[b, i] + k * parts + j]
                for s in range(stride):
                    step_lanes(x_b, q_b, u, t_b, ((k * parts + j) * stride + s) * h, h)
            out[b, k, :] = x_b'''


def follow_text(resolver: "Resolver", states: list[str], rates: list[str], names: list[str]) -> str:
    """The entry point that drives the effects along a measured motion."""
    own = [s for s in states if resolver.states[s].name not in FRAME]
    measured = [s for s in states if s not in own]

    def between(suffix: str, share: str) -> list[str]:
        return [f"{s}{suffix} = X[k, {i}] + {share} * (X[k + 1, {i}] - X[k, {i}])" for i, s in enumerate(measured)]

    lines = ["U = voltage[k * parts + s // stride]", "t = t0 + (k * steps + s) * h", "half = 0.5 * h"]
    lines += [*between("", "(s / steps)"), evaluate(states, rates, names, "", "t")]
    lines += [*between("_m", "((s + 0.5) / steps)"), *(half_step(s, rates) for s in own)]
    lines += [evaluate(states, rates, names, "_m", "t + half"), *between("_n", "((s + 1) / steps)")]
    lines += [f"mean_{s} += d_{s}" for s in states]
    swinging = [s for s in own if is_velocity(s, resolver)]
    if swinging:
        lines += kick(swinging, rates)
        lines.append(evaluate(states, rates, names, "_m", "t + half"))
    lines += [whole_step(s, rates, "relaxation") for s in own if s not in swinging]
    targets = ", ".join(s if s in own else "_" for s in states) + ","
    lines.append(f"{targets} = after_step({', '.join([*(s + '_n' for s in states), 'U', 't + h', *names])})")
    body = "\n".join("            " + line for line in lines)
    load = "\n".join(f"    {s} = X[0, {states.index(s)}]" for s in own)
    clear = "\n".join(f"        mean_{s} = 0.0" for s in states)
    keep = "\n".join(f"        X[k + 1, {states.index(s)}] = {s}" for s in own)
    store = "\n".join(f"        out[k + 1, {i}] = mean_{s} / steps" for i, s in enumerate(states))
    return f'''@entry
def follow(X, q, voltage, t0, h, stride, parts, out):
    """Advance the effects' own states along measured motion and pressures, interpolated between samples.

    X (samples, states): the frame's columns are given, the others are filled in from row 0 on; out (samples, states):
    mean derivatives over the interval that ends there, in which `parts` voltages are held for `stride` steps each.
    """
{_unpack(names, "q", "{0}")}
{load}
    steps = stride * parts
    for k in range(X.shape[0] - 1):
{clear}
        for s in range(steps):
{body}
{keep}
{store}'''


def pointwise_text(name: str, function: str, states: list[str], width: int, names: list[str]) -> str:
    """An entry point that evaluates an inlined function at every row of a trajectory."""
    arguments = [f"X[k, {i}]" for i in range(len(states))] + ["voltage[k]", "t[k]", *names]
    store = "\n".join(f"        out[k, {i}] = values[{i}]" for i in range(width))
    return f'''@entry
def {name}(X, q, voltage, t, out):
    """Evaluate `{function}` at every row of X (samples, states) into out (samples, {width})."""
{_unpack(names, "q", "{0}")}
    for k in range(X.shape[0]):
        values = {function}({", ".join(arguments)})
{store}'''


def sense_text(states: list[str], width: int, names: list[str]) -> str:
    """The entry point that says what the sensors read along many lanes, each with its own parameters."""
    arguments = [f"X[b, k, {i}]" for i in range(len(states))] + ["U", "t", *names]
    unpack = "\n".join(f"        {name} = q[b, {i}]" for i, name in enumerate(names))
    store = "\n".join(f"            out[b, k, {i}] = values[{i}]" for i in range(width))
    return f'''@entry
def sense(X, q, voltage, first, t0, interval, parts, out):
    """What the sensors read at every row of X (lanes, samples, states) into out (lanes, samples, {width}).

    q (lanes, parameters); first, t0 (lanes,) as in `run_lanes`; samples are `interval` apart.
    """
    for b in range(X.shape[0]):
{unpack}
        for k in range(X.shape[1]):
            U = voltage[first[b] + (k + 1) * parts - 1]
            t = t0[b] + (k + 1) * interval
            values = sensing({", ".join(arguments)})
{store}'''
