"""Write one step of the integrator, whose scheme is described in `compose`."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pneumo_ros.plant.compose import Resolver


def evaluate(resolver: "Resolver", rates: list[str], names: list[str], suffix: str, time: str) -> str:
    """Line that evaluates all derivatives at the states with `suffix`."""
    slopes = ", ".join([f"d_{s}" for s in resolver.states] + [f"r_{s}" for s in rates]) + ","
    arguments = [*(s + suffix for s in resolver.states), *resolver.inputs, time, *names]
    return f"{slopes} = derivatives({', '.join(arguments)})"


def half_step(s: str, rates: list[str]) -> str:
    """Line of the first half step of state `s`, into `s_m`."""
    return f"{s}_m = {s} + " + (f"half * damped(r_{s} * half) * d_{s}" if s in rates else f"half * d_{s}")


def whole_step(s: str, rates: list[str], weight: str) -> str:
    """Line of the whole step of state `s`, into `s_n`, from the derivatives at mid step."""
    exponential = f"h * {weight}(r_{s} * h) * (d_{s} + r_{s} * ({s}_m - {s}))"
    return f"{s}_n = {s} + " + (exponential if s in rates else f"h * d_{s}")


def is_velocity(s: str, resolver: "Resolver") -> bool:
    """Whether a state takes its step with the velocities."""
    return resolver.states[s].states[s].is_velocity


def kick(velocities: list[str], rates: list[str]) -> list[str]:
    """Lines of the whole step of velocities, and of their means over the step."""
    lines = [whole_step(s, rates, "damped") for s in velocities]
    return lines + [f"{s}_m = 0.5 * ({s} + {s}_n)" for s in velocities]


def step_text(resolver: "Resolver", states: list[str], rates: list[str], names: list[str]) -> str:
    """The inlined function `step`."""
    velocities = [s for s in states if is_velocity(s, resolver)]
    lines = ["half = 0.5 * h", "middle = t + half", evaluate(resolver, rates, names, "", "t")]
    lines += [half_step(s, rates) for s in states]
    lines.append(evaluate(resolver, rates, names, "_m", "middle"))
    lines += kick(velocities, rates)
    lines.append(evaluate(resolver, rates, names, "_m", "middle"))
    lines += [whole_step(s, rates, "relaxation") for s in states if s not in velocities]
    inputs = resolver.inputs
    lines.append(f"return after_step({', '.join([*(s + '_n' for s in states), *inputs, 't + h', *names])})")
    body = "\n".join("    " + line for line in lines)
    return f"@inline\ndef step({', '.join([*states, *inputs, 't', 'h', *names])}):\n{body}"
