"""Control laws on the default machine and on others: tracking, arrival, valve activity; published protocols; time.

All laws have the gains of config/control, found by one procedure (`pneumo tune`), and use the default machine file,
also when the plant is another machine. Sensors: 10 um and 300 Pa of noise, no velocity; 1 kHz. The sine is 0.3 m, 0.05
Hz; the moves are 60 mm in 1 s, held for 19 s.
"""

import argparse
import time

import control_cases as cases
import numpy as np
from control_cases import AXIS, HOLD, SINE, STEADY, follow, shipped

from pneumo_ros.control import LAWS, Law, Measurement
from pneumo_ros.control.figures import Arrival, arrivals, tracking
from pneumo_ros.control.reference import sine, steps
from pneumo_ros.plant import Model, load_model

SEEDS = range(8)  # of the noise
ZHU_STEADY = 5e-5  # m, of Zhu and Barth


def main() -> None:
    """Print the tables that the options name, by default all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=("plants", "published", "discovery", "time"), help="one of the tables")
    only = parser.parse_args().only
    tables = {"plants": plants, "published": published, "discovery": discovery, "time": step_time}
    for name, table in tables.items():
        if only in (None, name):
            table()


def plants() -> None:
    """Every law on every plant."""
    head = f"{'plant':21} {'law':13} {'rms':>6} {'peak':>7} {'V/s':>6} {'slips':>6}"
    print(f"{head} | {'steady':>7} {'settling':>9} {'hunting':>8}   [mm, s]; steady, hunting: worst of 4 moves")
    for name, plant in cases.PLANTS.items():
        for law in LAWS:
            _row(name, plant, law)
    slow = cases.PLANTS["spool dynamics"]
    print("once the machine file knows the spool:")
    _row("spool dynamics", slow, "cascade", slow)
    _targets()


def _row(name: str, plant: Model, law: str, known: Model = AXIS) -> None:
    """Print how a law with the file of one machine controls another machine."""
    along = tracking(follow(plant, shipped(law, known), SINE, cases.SINE_SECONDS)[0], cases.SINE_BEGIN)
    ends = arrivals(follow(plant, shipped(law, known), cases.STEPS, 5 * HOLD)[0], HOLD, STEADY)
    print(
        f"{name:21} {law:13} {1e3 * along.rms:6.2f} {1e3 * along.peak:7.2f} {along.activity:6.0f} "
        f"{along.breakaways:6d} | {1e3 * max(e.error for e in ends):7.2f} {_settled(ends, STEADY):>9} "
        f"{1e3 * max(e.motion for e in ends):8.3f}",
        flush=True,
    )


def _settled(ends: list[Arrival], tolerance: float) -> str:
    """When the slowest move has settled."""
    return "never" if max(e.error for e in ends) > tolerance else f"{max(e.settling for e in ends):.2f} s"


def _targets() -> None:
    """The nominal figures beside their targets."""
    print(
        f"nominal, the same sine with {len(SEEDS)} draws of the noise (targets: at most 1.50 mm, at least 3.0 x better)"
    )
    _compared("gains of config/control", shipped("pid"), shipped("cascade"))
    _compared("gains for this sine alone", *(cases.own(f"{law}_for_sine.yaml", AXIS) for law in ("pid", "cascade")))
    raw = arrivals(follow(AXIS, shipped("cascade"), steps(cases.LEVELS, HOLD), 5 * HOLD)[0], HOLD, STEADY)
    print(
        f"cascade, steps of 60 mm without a profile: steady {1e3 * max(e.error for e in raw):.2f} mm (target: at most "
        f"0.30), settled: {_settled(raw, STEADY)}, motion afterwards "
        f"{1e3 * max(e.motion for e in raw):.3f} mm"
    )


def _compared(title: str, pid: Law, cascade: Law) -> None:
    """Print both laws along the sine, from the best draw to the worst."""
    one, other = (np.array([_rms(law, seed) for seed in SEEDS]) for law in (pid, cascade))
    ratios, overall = one / other, np.sqrt(np.mean(one**2) / np.mean(other**2))
    print(
        f"  {title}: PID {1e3 * one.min():.2f} to {1e3 * one.max():.2f} mm rms, cascade {1e3 * other.min():.2f} to "
        f"{1e3 * other.max():.2f} mm, {ratios.min():.1f} to {ratios.max():.1f} x better, {overall:.1f} x overall",
        flush=True,
    )


def _rms(law: Law, seed: int) -> float:
    """Error along the sine [m]."""
    return tracking(follow(AXIS, law, SINE, cases.SINE_SECONDS, seed)[0], cases.SINE_BEGIN).rms


def published() -> None:
    """The protocols of two papers, on a cylinder as large as theirs, and on one that differs from its machine file."""
    short = load_model(cases.HERE / "short_cylinder.yaml")
    other = short.with_effects(
        [*short.effects, "valve_spool_dynamics"], {"valve_spool_dynamics.angular_frequency": 400}
    )
    other = other.with_parameters({name: 1.2 * short[name] for name in cases.FRICTION})
    known, unknown = _protocols(short, short), _protocols(short, other)
    print("\nThe cascade, in simulation, on a cylinder of the size of published experiments (short_cylinder.yaml), and")
    print("on one with 20 % more friction and a spool of 400 rad/s that its machine file does not know")
    print(f"{'protocol':36} {'published':>17} {'as the file says':>26} {'not as it says':>26}")
    rows = (
        ("Bone and Ning 2007: 70 mm, 0.5 Hz", "rms < 0.4 mm"),
        ("Zhu and Barth 2010: 60 mm, 0.5 Hz", "within 0.7 mm"),
        ("Zhu and Barth 2010: 60 mm, 1 Hz", "within 1.2 mm"),
        ("Zhu and Barth 2010: steps of 60 mm", "steady < 0.05 mm"),
    )
    for (protocol, theirs), one, two in zip(rows, known, unknown, strict=True):
        print(f"{protocol:36} {theirs:>17} {one:>26} {two:>26}")


def _protocols(known: Model, plant: Model) -> list[str]:
    """Results of the cascade with the file of one machine on another machine."""
    found = []
    for amplitude, frequency in ((0.07, 0.5), (0.06, 0.5), (0.06, 1.0)):
        law = cases.own("short_cylinder_cascade.yaml", known)
        seen = tracking(follow(plant, law, sine(amplitude, frequency), 22.0)[0], 2.0)
        found.append(f"rms {1e3 * seen.rms:.3f}, peak {1e3 * seen.peak:.2f} mm")
    law = cases.own("short_cylinder_cascade.yaml", known)
    record = follow(plant, law, steps([k * cases.STEP for k in (0, 1, 0, 1, 0)], 3.0), 15.0)[0]
    ends = arrivals(record, 3.0, ZHU_STEADY)
    return [*found, f"steady {1e3 * max(end.error for end in ends):.3f} mm, {_settled(ends, ZHU_STEADY)}"]


def discovery() -> None:
    """Before and after an effect was found."""
    from control_discovery import show

    show()


def step_time() -> None:
    """Time of one step of each law, of steps along the sine."""
    print(f"\n{'one control step':16} {'median':>10} {'99 %':>10}   (target: under 20 us)")
    for law in LAWS:
        _, shown = follow(AXIS, shipped(law), SINE, 10.0)
        taken = _replayed(law, shown)
        print(f"{law:16} {np.median(taken):7.1f} us {np.percentile(taken, 99):7.1f} us")


def _replayed(name: str, shown: np.ndarray) -> np.ndarray:
    """Times [us] of the steps for the same measurements again, without the plant."""
    law, taken = shipped(name), np.empty(len(shown))
    for k, (t, y, a, b) in enumerate(shown.tolist()):
        wanted, seen = SINE(t), Measurement(t, y, None, a, b)
        begin = time.perf_counter_ns()
        law.step(wanted, seen)
        taken[k] = 1e-3 * (time.perf_counter_ns() - begin)
    return taken


if __name__ == "__main__":
    main()
