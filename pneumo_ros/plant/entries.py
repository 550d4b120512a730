"""Write the compiled entry points of a kernel: each loops over samples and calls inlined functions."""

LANES = 16  # parameter sets that advance together; a multiple of every SIMD width


def unpack(names: list[str], array: str, index: str) -> str:
    """Lines that give the entries of an array their names."""
    return "\n".join(f"    {name} = {array}[{index.format(i)}]" for i, name in enumerate(names))


def run_text(states: list[str], names: list[str]) -> str:
    """The entry point of single runs."""
    targets = ", ".join(states) + ","
    store = "\n".join(f"        out[k, {i}] = {s}" for i, s in enumerate(states))
    final = "\n".join(f"    x[{i}] = {s}" for i, s in enumerate(states))
    return f'''@entry
def run(x, q, voltage, t0, h, stride, parts, out):
    """Advance x (states,); out (samples, states) after each sample of `parts` held voltages of `stride` steps each."""
{unpack(names, "q", "{0}")}
{unpack(states, "x", "{0}")}
    for k in range(out.shape[0]):
        for j in range(parts):
            U = voltage[k * parts + j]
            for s in range(stride):
                t = t0 + ((k * parts + j) * stride + s) * h
                {targets} = step({", ".join([*states, "U", "t", "h", *names])})
{store}
{final}'''


def lanes_text(states: list[str], names: list[str]) -> str:
    """The entry point of many lanes at once, and the function that advances one block of them."""
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
            for j in range(out.shape[2]):  # to assign a slice would take a second to compile
                out[b, k, j] = x_b[j]'''


def pointwise_text(name: str, function: str, states: list[str], width: int, names: list[str]) -> str:
    """An entry point that evaluates an inlined function at every row of a trajectory."""
    arguments = [f"X[k, {i}]" for i in range(len(states))] + ["voltage[k]", "t[k]", *names]
    store = "\n".join(f"        out[k, {i}] = values[{i}]" for i in range(width))
    return f'''@entry
def {name}(X, q, voltage, t, out):
    """Evaluate `{function}` at every row of X (samples, states) into out (samples, {width})."""
{unpack(names, "q", "{0}")}
    for k in range(X.shape[0]):
        values = {function}({", ".join(arguments)})
{store}'''


def sense_text(states: list[str], width: int, names: list[str]) -> str:
    """The entry point for the sensor readings along many lanes, each with its own parameters."""
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
