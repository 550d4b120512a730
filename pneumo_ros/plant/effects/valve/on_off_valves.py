"""Valves that are open or closed."""

from pneumo_ros.plant.effect import Effect, Parameter, State

ROUND = 6755399441055744.0  # 1.5 * 2**52: adding and subtracting it rounds to the nearest integer
NEAR = 0.1  # of the travel, over which a valve body comes to rest
SLOWEST = 0.1  # Hz: below it nothing pulses
EDGE = 1e-6  # of a period: edges at the end of a step fall in the same step, however the time is rounded


def fraction(x: float) -> float:
    """The part of x beyond the next lower integer."""
    beyond = x - ((x + ROUND) - ROUND)
    return beyond + 1.0 if beyond < 0.0 else beyond


def wanted_level(share: float, cycles: float, frequency: float, least_pulse: float, three_way: float) -> float:
    """Level that the coils of one chamber ask for: 1 fills, -1 empties, 0 closes; `cycles`: periods since the start."""
    shut = three_way < 0.5
    level = min(max(share, -1.0), 1.0)
    duty = abs(level) if shut else 0.5 + 0.5 * level
    least = min(least_pulse * frequency, 0.5)
    duty = 0.0 if duty < least else (1.0 if 1.0 - duty < least else duty)
    on = fraction(cycles + EDGE) < duty if frequency >= SLOWEST else duty >= 0.5
    rest = 0.0 if shut else -1.0
    moved = -1.0 if shut and level < 0.0 else 1.0
    return moved if on else rest


def next_level(level: float, wanted: float, three_way: float) -> float:
    """The level to which the valves go next: from filling to emptying, two 2/2 valves are both closed between."""
    return 0.0 if three_way < 0.5 and level * wanted < 0.0 else wanted


def delay_to(level: float, three_way: float, switch_on: float, switch_off: float) -> float:
    """Time from a change of the coil to the motion of the valve body towards that level."""
    return switch_off if level == (0.0 if three_way < 0.5 else -1.0) else switch_on


def moved_body(x: float, level: float, beyond: float, travel: float) -> float:
    """Position of a valve body that has moved towards a level for `beyond` seconds of this step already."""
    return x + min(max(level - x, -beyond / travel), beyond / travel)


class OnOffValves(Effect):
    """Each chamber has on/off valves, which pulses of width duty / f drive: duty = |U| / U_full of each period 1 / f.

    Four 2/2 valves: above 0 V one of a chamber's pair fills with that duty, below 0 V the other empties, at 0 V both
    are closed. Two 3/2 valves (`three_way` 1): with current they fill, without they empty; duty (1 + U / U_full) / 2.
    f = 0: the command itself switches, at half of U_full, and 3/2 valves at 0 V. A pulse, or a pause, shorter than
    `least_pulse` is left out. A valve body moves `switch_on` or `switch_off` after its coil, if that still asks for it,
    and takes the time `travel`; so a pulse shorter than the delay passes nothing.
    """

    share = Parameter(
        1.0, "1", "share of the opening that is these valves'", 0.0, 1.0, neutral=0.0, optional=True, chosen=True
    )
    three_way = Parameter(0.0, "1", "1 for 3/2 valves, 0 for pairs of 2/2 valves", low=0.0, high=1.0, chosen=True)
    full_signal = Parameter(10.0, "V", "command U_full of full duty", low=0.1, high=20.0, chosen=True)
    pulse_frequency = Parameter(50.0, "Hz", "frequency f of the pulses, 0 for none", low=0.0, high=200.0, chosen=True)
    phase = Parameter(
        0.0, "1", "share of a period that has passed at the start", low=0.0, high=1.0, optional=True, chosen=True
    )
    least_pulse = Parameter(
        0.0, "s", "least width of a pulse and of a pause", low=0.0, high=1.0, optional=True, chosen=True
    )
    switch_on = Parameter(5e-3, "s", "time from current to motion of the valve body", low=0.0, high=0.5)
    switch_off = Parameter(5e-3, "s", "time from no current to motion of the valve body", low=0.0, high=0.5)
    travel = Parameter(1e-3, "s", "time that the valve body moves", low=2e-4, high=0.2, chosen=True)

    body_a = State("1", "position of the valves of chamber a: 1 fills, -1 empties")
    body_b = State("1", "position of the valves of chamber b: 1 fills, -1 empties")
    level_a = State("1", "level to which the valves of chamber a have been switched")
    level_b = State("1", "level to which the valves of chamber b have been switched")
    wait_a = State("s", "how long the coils of chamber a have asked for another level")
    wait_b = State("s", "how long the coils of chamber b have asked for another level")

    source = (
        "van Varseveld and Bone 1997, Accurate position control of a pneumatic actuator using on/off solenoid valves "
        "(pulses, delays, dead band of short pulses)"
    )
    signature = "both flows come in pulses of one size, whose width follows the command"
    remedy = "compare both delays with the data sheet; longer ones are those of the driver, or of dirt in the valve"
    part = True

    def equations(opening_a, opening_b, body_a, body_b, level_a, level_b, share, full_signal, travel):
        rate_body_a = 1.0 / (travel * max(abs(level_a - body_a), NEAR))
        rate_body_b = 1.0 / (travel * max(abs(level_b - body_b), NEAR))
        der_body_a = rate_body_a * (level_a - body_a)
        der_body_b = rate_body_b * (level_b - body_b)
        second = travel / travel  # the clocks of both chambers run at 1 s/s
        der_wait_a, der_wait_b = second, second
        opening_a = opening_a + share * (full_signal * body_a - opening_a)
        opening_b = opening_b + share * (full_signal * body_b - opening_b)
        return opening_a, opening_b, der_body_a, der_body_b, rate_body_a, rate_body_b, der_wait_a, der_wait_b

    def advance(
        asked_a, asked_b, t, body_a, body_b, level_a, level_b, wait_a, wait_b, three_way, full_signal, pulse_frequency,
        phase, least_pulse, switch_on, switch_off, travel,
    ):  # fmt: skip
        cycles = t * pulse_frequency + phase
        wanted_a = wanted_level(asked_a / full_signal, cycles, pulse_frequency, least_pulse, three_way)
        wanted_b = wanted_level(asked_b / full_signal, cycles, pulse_frequency, least_pulse, three_way)
        wait_a = 0.0 * wait_a if wanted_a == level_a else wait_a
        wait_b = 0.0 * wait_b if wanted_b == level_b else wait_b
        next_a, next_b = next_level(level_a, wanted_a, three_way), next_level(level_b, wanted_b, three_way)
        beyond_a = wait_a - delay_to(next_a, three_way, switch_on, switch_off)
        beyond_b = wait_b - delay_to(next_b, three_way, switch_on, switch_off)
        go_a, go_b = next_a != level_a and beyond_a >= 0.0, next_b != level_b and beyond_b >= 0.0
        level_a, level_b = next_a if go_a else level_a, next_b if go_b else level_b
        body_a = moved_body(body_a, level_a, beyond_a, travel) if go_a else body_a
        body_b = moved_body(body_b, level_b, beyond_b, travel) if go_b else body_b
        return body_a, body_b, level_a, level_b, wait_a, wait_b
