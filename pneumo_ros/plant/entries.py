"""Write the compiled entry points of a kernel: each loops over samples and calls inlined functions."""

LANES = 16  # parameter sets that advance together; a multiple of every SIMD width


def unpack(names: list[str], array: str, index: str) -> str:
    """Lines that give the entries of an array their names."""
    return "\n".join(f"    {name} = {array}[{index.format(i)}]" for i, name in enumerate(names))


def take(inputs: list[str], row: str) -> list[str]:
    """Lines that give the inputs in a row of `inputs` their names."""
    return [f"{name} = inputs[{row}, {i}]" for i, name in enumerate(inputs)]


def run_text(states: list[str], inputs: list[str], names: list[str]) -> str:
    """The entry point of single runs."""
    targets = ", ".join(states) + ","
    store = "\n".join(f"        out[k, {i}] = {s}" for i, s in enumerate(states))
    final = "\n".join(f"    x[{i}] = {s}" for i, s in enumerate(states))
    held = "\n".join("            " + line for line in take(inputs, "k * parts + j"))
    return f'''@entry
def run(x, q, inputs, t0, h, stride, parts, out):
    """Advance x (states,); out (samples, states) after each sample of `parts` held inputs of `stride` steps each.

    inputs (samples * parts, {len(inputs)}): {", ".join(inputs)}.
    """
{unpack(names, "q", "{0}")}
{unpack(states, "x", "{0}")}
    for k in range(out.shape[0]):
        for j in range(parts):
{held}
            for s in range(stride):
                t = t0 + ((k * parts + j) * stride + s) * h
                {targets} = step({", ".join([*states, *inputs, "t", "h", *names])})
{store}
{final}'''


def lanes_text(states: list[str], inputs: list[str], names: list[str]) -> str:
    """The entry point of many lanes at once, and the function that advances one block of them."""
    arguments = [f"x[{i * LANES} + i]" for i in range(len(states))]
    arguments += [f"u[{i * LANES} + i]" for i in range(len(inputs))] + ["t[i] + elapsed", "h"]
    arguments += [f"q[{i * LANES} + i]" for i in range(len(names))]
    targets = ", ".join(states) + ","
    store = "\n".join(f"        x[{i * LANES} + i] = {s}" for i, s in enumerate(states))
    hold = "\n".join(f"                    u[{i * LANES} + i] = inputs[row, {i}]" for i in range(len(inputs)))
    return f'''@inline
def step_lanes(x, q, u, t, elapsed, h):
    for i in range(LANES):
        {targets} = step({", ".join(arguments)})
{store}


@entry
def run_lanes(x, q, inputs, first, t0, h, stride, parts, out):
    """Advance blocks of LANES independent lanes.

    x (blocks, states * LANES), q (blocks, parameters * LANES), first (blocks, LANES): index of each lane's first row in
    `inputs`, t0 (blocks, LANES), out (blocks, samples, states * LANES); samples and inputs as in `run`.
    """
    u = np.empty({len(inputs)} * LANES)
    for b in range(x.shape[0]):
        x_b, q_b, t_b = x[b], q[b], t0[b]
        for k in range(out.shape[1]):
            for j in range(parts):
                for i in range(LANES):
                    row = first[b, i] + k * parts + j
{hold}
                for s in range(stride):
                    step_lanes(x_b, q_b, u, t_b, ((k * parts + j) * stride + s) * h, h)
            for j in range(out.shape[2]):  # to assign a slice would take a second to compile
                out[b, k, j] = x_b[j]'''


def pointwise_text(name: str, function: str, states: list[str], inputs: list[str], width: int, names: list[str]) -> str:
    """An entry point that evaluates an inlined function at every row of a trajectory."""
    arguments = [f"X[k, {i}]" for i in range(len(states))] + [f"inputs[k, {i}]" for i in range(len(inputs))]
    arguments += ["t[k]", *names]
    store = "\n".join(f"        out[k, {i}] = values[{i}]" for i in range(width))
    return f'''@entry
def {name}(X, q, inputs, t, out):
    """Evaluate `{function}` at every row of X (samples, states) into out (samples, {width})."""
{unpack(names, "q", "{0}")}
    for k in range(X.shape[0]):
        values = {function}({", ".join(arguments)})
{store}'''


def sense_text(states: list[str], inputs: list[str], width: int, names: list[str]) -> str:
    """The entry point for the sensor readings along many lanes, each with its own parameters."""
    arguments = [f"X[b, k, {i}]" for i in range(len(states))] + [*inputs, "t", *names]
    held = "\n".join("            " + line for line in take(inputs, "first[b] + (k + 1) * parts - 1"))
    unpack = "\n".join(f"        {name} = q[b, {i}]" for i, name in enumerate(names))
    store = "\n".join(f"            out[b, k, {i}] = values[{i}]" for i in range(width))
    return f'''@entry
def sense(X, q, inputs, first, t0, interval, parts, out):
    """What the sensors read at every row of X (lanes, samples, states) into out (lanes, samples, {width}).

    q (lanes, parameters); first, t0 (lanes,) as in `run_lanes`; samples are `interval` apart.
    """
    for b in range(X.shape[0]):
{unpack}
        for k in range(X.shape[1]):
{held}
            t = t0[b] + (k + 1) * interval
            values = sensing({", ".join(arguments)})
{store}'''
