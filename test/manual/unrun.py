"""Which statements of the pages another test runs, and how long ones are shortened."""

import re
import sys
from pathlib import Path

ELSEWHERE = {  # pattern of a statement that is not run here, but by another test of make test or make check -> which
    r"make test$": "it is the tests",
    r"make demo$|pneumo demo$": "test/command/test_demo.py runs it",
    r"make supply": "a stage of make check",
    r"python3 -m colcon build|\. install/setup.sh": "test/packaging/test_installs.py builds with colcon and sources it",
    r"rosdep ": "test/packaging/test_rosdep.py simulates it, with databases of its own",
}
UNRUN_CODE = {  # page -> languages of blocks that are no program
    "commissioning.md": {"text": "what the command prints"},
    "machine_files.md": {
        "yaml": "a part of a machine file; test_code reads it as YAML and finds its names in axis.yaml"
    },
}
_MAKE = f"-o .venv/ready BIN={Path(sys.executable).parent}"  # with this environment, as it is
AT_THE_TOP = r"make |python benchmarks/|pip install "  # pattern of statements that are typed in the checkout
MORE = {  # pattern -> options that keep a check short; $PAGE is the folder of the page
    r"pneumo diagnose (?!.*--within)": "--within 60",
    r"pneumo tune (?!.*--evaluations)": "--evaluations 4",
    r"pneumo workbench ": "--port 0",
    r"pneumo commission .*--folder": "--stage 0 --overwrite --folder moved_again",
    r"pneumo commission ": "--stage 0 --overwrite --folder moved",
    r"pneumo experiment constant-voltage --namespace": "--voltages 3 --seconds 1 --out moved",
    r"python benchmarks/bench_kernel": "--repetitions 1 --starts 1",
    r"python benchmarks/bench_export": "--repetitions 1",
    r"python benchmarks/bench_bag_reading": "--messages 2000 --repetitions 1",
    r"python benchmarks/bench_identify": "--seeds 1",
    r"python benchmarks/bench_control": "--only time",
    r"python benchmarks/bench_nodes": "--seconds 3 --answer-seconds 1",
    r"python benchmarks/bench_fleet": "--most 2 --processes 1 --no-diagnosis",
    r"python benchmarks/bench_blind": "--kind healthy=1 --excitation steps --first-seed 20000 --json $PAGE/blind.jsonl",
    r"python benchmarks/fleet_of_leaks": "--weeks 1 --motions steps",
    r"ros2 launch .* record:=run_1": "record:=launched_1",  # the page's next line reads another run_1
    r"make fuzz": f'{_MAKE} FUZZ="--inputs 40 --cuts 5 --only file"',
    r"make chaos": f'{_MAKE} CHAOS="--faults 1"',
    r"make endurance": f'{_MAKE} ENDURANCE="--hours 0.01 --minutes 0"',
    r"make ": _MAKE,
    r"pip install ": "--dry-run --no-build-isolation",
}
SERVING = {  # pattern of a statement that runs until Ctrl-C -> what it says when it is up
    r"simulator |controller |recorder |commission ": r"ready|recording",
    r"pneumo workbench ": r"http://",
    r"ros2 run pneumo_ros simulator ": r"ready",
    r"ros2 launch ": r"ready",
}
INSIDE = (0, 1)  # exit codes of a statement that worked: done, or done but outside what was asked


def first(table: dict[str, str], text: str) -> str | None:
    """The entry of a table whose pattern begins a statement."""
    return next((entry for pattern, entry in table.items() if re.match(pattern, text)), None)


def shortened(text: str) -> str:
    """A statement with the options that keep it short."""
    more = first(MORE, text)
    return f"{text} {more}" if more else text
