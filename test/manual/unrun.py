"""Which statements of the pages the checks do not run, each with the reason; and how long ones are shortened."""

import re

UNRUN = {  # pattern of a statement -> why it is not run here, and what follows it instead
    r"make (demo|test)$": "the tests themselves; and the demo, which test/command/test_demo.py runs",
    r"make (paper|fuzz|chaos|endurance|supply)": "minutes to hours; their parts are tested: test_paper, test_fuzz",
    r"python benchmarks/": "minutes to hours: make bench; test/test_benchmarks.py holds what they assume",
    r"pneumo demo$": "test/command/test_demo.py runs it",
    r"pneumo new$": "asks at a terminal; test/command/test_new.py answers",
    r"pneumo commission ": "moves a live plant for minutes; test/ros and test/commission do so",
    r"pneumo experiment constant-voltage --namespace": "moves a live plant for minutes; test/ros does so",
    r"pneumo fleet .*dask=": "needs a cluster",
    r"pneumo fleet fleet$": "the twelve machines that benchmarks/fleet_of_leaks.py records in minutes",
    r"ros2 |rosdep |\. install/setup.sh|python3 -m colcon |python3 -m venv ": "needs a ROS 2 distribution; "
    "test/packaging builds with colcon and reads the launch files",
    r"pip install ": "needs a network; make supply installs the wheel",
}
UNRUN_CODE = {  # page -> languages of blocks that are no program
    "commissioning.md": {"text": "what the command prints"},
    "machine_files.md": {
        "yaml": "a part of a machine file; test_code reads it as YAML and finds its names in axis.yaml"
    },
}
MORE = {  # pattern -> options that keep a check short
    r"pneumo diagnose (?!.*--within)": "--within 60",
    r"pneumo tune (?!.*--evaluations)": "--evaluations 4",
    r"pneumo workbench ": "--port 0",
}
SERVING = {  # pattern of a statement that runs until Ctrl-C -> what it says when it is up
    r"simulator |controller |recorder |commission ": r"ready|recording",
    r"pneumo workbench ": r"http://",
}
INSIDE = (0, 1)  # exit codes of a statement that worked: done, or done but outside what was asked


def first(table: dict[str, str], text: str) -> str | None:
    """The entry of a table whose pattern begins a statement."""
    return next((entry for pattern, entry in table.items() if re.match(pattern, text)), None)


def shortened(text: str) -> str:
    """A statement with the options that keep it short."""
    more = first(MORE, text)
    return f"{text} {more}" if more else text
