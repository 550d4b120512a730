"""Every effect of the rig: it has an influence, is finite and resolved, and follows the physics."""

import functools
import math

import numpy as np
import pytest
from rig import effects, friction, gas, loop, rates, sensors, valve
from rig.machine import SMOOTH, Machine, packed
from scipy.signal import lfilter

pytestmark = pytest.mark.check  # they judge the independent rig, not the package

AT_SENSORS = {*effects.SENSORS, "backlash"}
AT_ENDS = {"cushioning"}
IN_MOTION = [name for name in effects.EFFECTS if name not in AT_SENSORS | AT_ENDS]
OTHER_LAWS = {"choked_flow", "heat_exchange"}  # no size of theirs gives the base law
MANOEUVRE = np.concatenate([np.full(400, 2.0), np.full(1000, -2.5), np.zeros(200), np.full(400, 0.95)])
BASE = Machine()
COARSE = 4e-5  # s, twice the step of recordings
COLUMN = {name: k for k, name in enumerate(rates.STATES)}


def hidden(name, size=None):
    effect = effects.find(name)
    rng = np.random.default_rng(1)
    return effect.apply(BASE, effect.draw(rng) if size is None else size, rng)


@functools.cache
def base_run():
    return run(BASE, step=COARSE)[0]


def run(machine, voltage=MANOEUVRE, step=loop.STEP, y=0.1, p_a=3e5):
    states, _ = loop.run(machine, SMOOTH, loop.rest(machine, y, p_a), voltage, step=step)
    return loop.readings(machine, states), states


@pytest.mark.parametrize("name", IN_MOTION)
def test_effect_changes_the_motion_and_is_resolved_by_the_step(name):
    x, base = run(hidden(name), step=COARSE)[0], base_run()
    finer = run(hidden(name))[0]
    changed = np.abs(x - base).max(axis=0)[:4]
    error = np.abs(x - finer).max(axis=0)[:4]
    assert np.all(np.isfinite(x))
    assert changed[0] > 1e-5 or changed[2] > 100.0 or changed[3] > 100.0
    assert np.all(error < [1e-6, 5e-4, 1.0, 1.0])


@pytest.mark.parametrize("name", [name for name in IN_MOTION if name not in OTHER_LAWS])
def test_weaker_is_nearer_to_the_base(name):
    effect = effects.find(name)
    full = effect.draw(np.random.default_rng(1))
    shares = [hidden(name, effect.weaken(full, share)) for share in (1.0, 0.02)]
    away = [np.abs(run(machine, step=COARSE)[0] - base_run())[:, 2].sum() for machine in shares]
    assert away[1] < 0.3 * away[0]


def test_cushion_brakes_before_the_end():
    machine = hidden("cushioning")
    x, base = run(machine, np.full(4000, 3.0), y=0.7)[0], run(BASE, np.full(4000, 3.0), y=0.7)[0]
    before = base[:, 0] < 0.97
    assert x[before] == pytest.approx(base[before], abs=1e-9)
    assert x[:, 3].max() > base[1000:, 3].max() + 1e4
    arriving = [run_[np.flatnonzero(run_[:, 0] > 0.999)[0], 1] for run_ in (x, base)]
    assert arriving[0] < arriving[1] - 5e-4


def test_closed_leaking_piston_keeps_its_gas_and_evens_out():
    machine = BASE._replace(cross=1e-9, coulomb=1e4, static=2e4)
    x, states = run(machine, np.zeros(8000))
    masses = states[:, COLUMN["gas_a"]] + states[:, COLUMN["gas_b"]]
    assert masses == pytest.approx(masses[0], rel=1e-12)
    assert abs(x[-1, 2] - x[-1, 3]) < 0.2 * abs(x[0, 2] - x[0, 3])


def test_energy_of_the_closed_machine_without_friction_is_conserved():
    machine = BASE._replace(coulomb=1e-6, static=2e-6, bristle=1e-3, bristle_damping=0.0, drag=0.0)
    rest = loop.rest(machine, 0.1, 3e5)
    rest[COLUMN["energy_a"]] *= 1.05
    rest[COLUMN["bristle"]] = 0.0
    states, _ = loop.run(machine, SMOOTH, rest, np.zeros(2000))
    y, v = states[:, 0], states[:, 1]
    work = machine.atmosphere * (machine.area_a - machine.area_b) * y
    total = states[:, COLUMN["energy_a"]] + states[:, COLUMN["energy_b"]] + 0.5 * machine.mass * v**2 + work
    assert np.abs(v).max() > 0.1
    assert np.abs(y).max() < 1.0
    assert np.ptp(total) < 1e-6 * 0.5 * machine.mass * np.abs(v).max() ** 2 + 1e-6


@pytest.mark.parametrize("wall_time", [1e-3, 1e3])
def test_walls_make_the_air_spring_isothermal_or_leave_it_adiabatic(wall_time):
    """A closed chamber pushed slowly or fast keeps p V or p V^gamma."""
    machine = BASE._replace(wall_time=wall_time, load=30.0, coulomb=1e-3, static=2e-3, drag=3e4)
    x, _ = run(machine, np.zeros(3000))
    volume = machine.volume_a + machine.area_a * x[:, 0]
    index = 1.0 if wall_time < 1.0 else machine.adiabatic
    kept = x[:, 2] * volume**index
    assert np.ptp(volume) > 0.02 * volume[0]
    assert kept == pytest.approx(kept[0], rel=2e-3)


def test_gas_warmed_by_filling_cools_to_the_wall():
    machine = BASE._replace(wall_time=0.1, coulomb=1e4, static=2e4)
    _, states = run(machine, np.concatenate([np.full(200, 5.0), np.zeros(3000)]))
    specific = machine.gas_constant / (machine.adiabatic - 1.0)
    gas_temperature = states[:, COLUMN["energy_a"]] / states[:, COLUMN["gas_a"]] / specific
    assert gas_temperature[200] > machine.temperature + 5.0
    assert gas_temperature[-1] == pytest.approx(machine.temperature, abs=0.01)


def test_iso_flow_chokes_and_is_odd_and_smooth():
    machine = packed(BASE._replace(critical_ratio=0.3))
    sonic = 4e-9 * valve.REFERENCE_DENSITY * 7e5
    assert valve.iso_6358(machine, 4e-9, 7e5, 1e5) == pytest.approx(sonic)
    assert valve.iso_6358(machine, 4e-9, 7e5, 0.3 * 7e5) == pytest.approx(sonic)
    middle = math.sqrt(1.0 - ((0.65 - 0.3) / 0.7) ** 2)
    assert valve.iso_6358(machine, 4e-9, 7e5, 0.65 * 7e5) == pytest.approx(sonic * middle)
    assert valve.iso_6358(machine, 4e-9, 1e5, 7e5) == -valve.iso_6358(machine, 4e-9, 7e5, 1e5)
    near = [valve.iso_6358(machine, 4e-9, 7e5, 7e5 * (1.0 - part)) for part in (0.0, 1e-4, 0.999e-3, 1.001e-3)]
    assert near[0] == 0.0
    assert near[3] == pytest.approx(near[2], rel=5e-3)


def test_second_order_spool_answers_a_step_as_the_textbook_says():
    rate, damping = 60.0, 0.8
    machine = BASE._replace(spool_rate=rate, spool_damping=damping)
    _, states = run(machine, np.full(200, 2.0))
    t = np.arange(200) * 1e-3
    root = math.sqrt(1.0 - damping**2)
    phase = rate * root * t
    answer = 1.0 - np.exp(-damping * rate * t) * (np.cos(phase) + damping / root * np.sin(phase))
    assert states[:, COLUMN["spool"]] == pytest.approx(2.0 * answer, abs=1e-7)


def test_line_delays_the_pressures_by_its_delay():
    x = run(BASE._replace(line_delay=0.01, static=1e5, coulomb=1e5), np.full(200, 3.0))[0]
    base = run(BASE._replace(static=1e5, coulomb=1e5), np.full(200, 3.0))[0]
    assert np.ptp(x[:10, 2]) < 1.0  # the bristle still rings a little
    assert x[10:30, 2] == pytest.approx(base[:20, 2], rel=1e-3)


def test_friction_lag_answers_the_velocity_of_then():
    x = run(BASE, np.full(600, 2.0))[0]
    late, film = run(hidden("friction_lag", 5e-3), np.full(600, 2.0))[0], run(hidden("friction_lag:film", 5e-3))[0]
    broke = [np.flatnonzero(run_[:, 0] > 0.1 + 1e-3)[0] for run_ in (x, late, film)]
    assert broke[1] > broke[0]
    assert broke[2] > broke[0]


def test_tube_as_a_volume_fills_by_first_order():
    """Into a held chamber: the flow's lag is a lag of the pressure's rise."""
    held = BASE._replace(static=1e5, coulomb=1e5)
    x, base = (run(m, np.full(200, 3.0))[0][:, 2] for m in (held._replace(line_lag=0.01), held))
    lagged = lfilter([1.0 - math.exp(-0.1)], [1.0, -math.exp(-0.1)], base - base[0])
    assert x[150] - x[0] == pytest.approx(lagged[150], rel=0.02)


def test_spool_moves_no_faster_than_its_slew_rate():
    states = run(BASE._replace(spool_lag=2e-3, spool_slew=40.0), np.full(100, 2.0))[1]
    spool = states[:, COLUMN["spool"]]
    assert np.diff(spool).max() == pytest.approx(0.04, rel=1e-6)
    assert spool[-1] == pytest.approx(2.0, abs=1e-6)


@pytest.mark.parametrize(("v", "share"), [(0.0, 1.0), (0.01, 0.5), (0.03, 0.1)])
def test_rational_stribeck_falls_as_hess_and_soom_say(v, share):
    machine = packed(BASE._replace(stribeck=0.01, stribeck_rational=1.0))
    level = friction.level(machine, 0.0, v, 1.0, 3e5, 3e5, 0.0, 0.0, 0.0)
    assert level == pytest.approx(BASE.coulomb + share * (BASE.static - BASE.coulomb))


def test_rest_may_raise_the_breakaway_by_its_logarithm():
    machine = packed(BASE._replace(rest_rise=30.0, rest_time=0.05, rest_log=1.0))
    rest = [friction.level(machine, 0.0, 0.0, 1.0, 3e5, 3e5, age, 0.0, 0.0) for age in (0.0, 0.5, 10.0)]
    assert rest[0] == pytest.approx(BASE.static)
    assert rest[2] == pytest.approx(BASE.static + 30.0)
    assert rest[1] - rest[0] == pytest.approx(30.0 * math.log(11.0) / math.log(201.0))


def test_work_of_friction_warms_it():
    warm = BASE._replace(warm_work=0.4, warm_fast=1.0)
    x, states = run(warm, np.full(4000, 2.0), y=-0.9, p_a=5e5)
    assert states[-1, COLUMN["warmth"]] == pytest.approx(min(70.0 * x[-1, 1] / 20.0, 1.0), abs=0.4)
    assert states[-1, COLUMN["bristle"]] * BASE.static < 0.85 * BASE.coulomb


def test_sublinear_film_is_that_of_the_linear_one_at_a_third_of_a_metre_per_second():
    linear, bent = (packed(BASE._replace(viscous_out=200.0, viscous_power=p)) for p in (1.0, 0.7))
    assert friction.film(bent, 0.3) == pytest.approx(friction.film(linear, 0.3))
    assert friction.film(bent, 0.03) - BASE.drag * 0.03**2 == pytest.approx(6.0 * 10.0**0.3)


@pytest.mark.parametrize("spread", [0.0, 1.0])
def test_play_gives_a_loop_of_its_width(spread):
    machine, plays = packed(BASE._replace(play=0.1, play_spread=spread)), np.zeros(5)
    slow = np.concatenate([np.linspace(0.0, 2.0, 200), np.linspace(2.0, -2.0, 400), np.linspace(-2.0, 2.0, 400)])
    shown = np.array([loop._slipped(plays, machine, u) for u in slow])
    down, up = shown[399], shown[799]
    assert slow[399] == pytest.approx(slow[800], abs=0.01)
    assert down - up == pytest.approx(0.2, abs=0.02)


def steady(machine, volts=2.0):
    """Column means over the last quarter of a slide, from a start near the steady state."""
    x = run(machine, np.full(6000, volts), y=-0.9, p_a=5e5)[0]
    return x[-500:].mean(axis=0)


@pytest.mark.parametrize(
    ("name", "size", "force"),
    [
        ("viscous_friction", 180.0, lambda v, y, p: 180.0 * v),
        ("asymmetric_viscous_friction", 100.0, lambda v, y, p: 30.0 * v),
        ("constant_load", 35.0, lambda v, y, p: 35.0),
        ("pressure_dependent_friction", 5e-5, lambda v, y, p: 5e-5 * (0.5 * (p[0] + p[1]) - 1e5)),
        ("asymmetric_friction", 0.3, lambda v, y, p: 0.0),
    ],
)
def test_force_of_an_effect_shows_in_the_balance_of_a_slide(name, size, force):
    _, v, p_a, p_b, _ = steady(hidden(name, size))
    gas_force = BASE.area_a * p_a - BASE.area_b * p_b - BASE.atmosphere * (BASE.area_a - BASE.area_b)
    slowing = 0.3  # N: remaining inertia force
    assert v > 0.1
    assert gas_force - BASE.coulomb - BASE.drag * v**2 == pytest.approx(force(v, 0.0, (p_a, p_b)), abs=slowing)


def test_coulomb_friction_alone_may_be_higher_in_retraction():
    machine = packed(hidden("asymmetric_friction:coulomb", 0.3))
    fast, still = (friction.level(machine, 0.0, v, -1.0, 3e5, 3e5, 0.0, 0.0, 0.0) for v in (1.0, 0.0))
    assert fast == pytest.approx(1.3 * BASE.coulomb)
    assert still == pytest.approx(BASE.static + 0.3 * BASE.coulomb)


def test_retracting_friction_is_higher_by_its_excess():
    machine = hidden("asymmetric_friction", 0.3)
    states = run(machine, np.full(6000, -2.0), y=0.9, p_a=1.5e5)[1]
    assert states[-1, COLUMN["bristle"]] * machine.static == pytest.approx(-1.3 * machine.coulomb, rel=1e-3)


def test_rest_raises_the_breakaway_and_sliding_forgets_it():
    machine = BASE._replace(rest_rise=30.0, rest_time=0.5, rest_power=0.6)
    volts = np.concatenate([np.full(1500, 2.0), np.zeros(8000), np.full(600, 2.0)])
    _, states = run(machine, volts)
    force = states[:, COLUMN["bristle"]] * machine.static
    age = states[:, COLUMN["age"]]
    assert age[1400] < 0.01
    assert age[9400] > 2.0
    assert force[9500:].max() > machine.static + 10.0
    assert force[9500:].max() <= machine.static + 30.0


def test_supply_droops_by_its_size_at_the_typical_flow_and_recovers():
    _, states = run(hidden("supply_pressure_droop", 5e4), np.concatenate([np.full(3000, 7.0), np.zeros(20000)]), y=-0.8)
    supply = states[:, COLUMN["supply"]]
    assert 1e4 < 7e5 - supply[2500] < 1.5e5
    assert supply[-1] == pytest.approx(7e5, rel=1e-3)


def test_outward_leaks_agree_where_they_are_gauged():
    machine = packed(BASE)
    linear, gap = (gas.outward_leak(machine, *both, 4e5) for both in ((1e-10, 0.0), (0.0, 1e-10)))
    assert gap == pytest.approx(linear)
    assert gas.outward_leak(machine, 0.0, 1e-10, 1e5) == 0.0


def recorded(machine, volts=MANOEUVRE):
    states, _ = loop.run(machine, SMOOTH, loop.rest(machine, 0.1, 3e5), volts)
    quiet = np.zeros(len(volts))
    return sensors.record("run", machine, states, volts, quiet, np.random.default_rng(0))


def test_delayed_encoder_shows_an_earlier_position():
    run_ = recorded(BASE._replace(position_delay=0.0075))
    middle = 0.5 * (run_.truth[100:-7, 0] + run_.truth[99:-8, 0])
    assert run_.position[107:] == pytest.approx(middle, abs=6e-6)


def test_filtered_encoder_lags_a_steady_slide_by_its_time_constant():
    run_ = recorded(BASE._replace(position_filter=0.01), np.full(3000, 2.0))
    y = run_.truth[:, 0]
    assert np.ptp(np.diff(y[2000:])) < 0.02 * np.diff(y[2000:]).mean()
    assert run_.position[2500] == pytest.approx(y[2490], abs=2e-5)


def test_loose_encoder_waits_at_reversals():
    run_ = recorded(BASE._replace(encoder_play=3e-4))
    lag = run_.truth[:, 0] - run_.position
    assert np.abs(lag).max() <= 3e-4 + 1e-5
    assert np.ptp(lag) > 5e-4


@pytest.mark.parametrize(
    ("field", "value", "slope", "offset"), [("offset_a", 1e4, 1.0, 1e4), ("gain_a", 0.02, 1.02, 0.0)]
)
def test_pressure_sensor_is_off_by_the_given_value(field, value, slope, offset):
    run_ = recorded(BASE._replace(**{field: value}))
    error = run_.pressure_a - (slope * run_.truth[:, 2] + offset)
    assert error.mean() == pytest.approx(0.0, abs=50.0)
    assert error.std() == pytest.approx(300.0, rel=0.1)
    assert (run_.pressure_b - run_.truth[:, 3]).mean() == pytest.approx(0.0, abs=50.0)


def test_misspelt_effect_is_answered_with_the_nearest():
    with pytest.raises(KeyError, match="viscous_friction"):
        effects.parse("viscous_fricton=100")


def test_effects_that_set_one_field_are_refused_together():
    with pytest.raises(ValueError, match="both set coupling"):
        effects.build(1, [effects.Wish("load_compliance"), effects.Wish("backlash:load")])
