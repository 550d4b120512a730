"""A pneumatic axis for ROS 2: its plant, control, recordings, and what its model is missing.

`import pneumo_ros as pn` offers the verbs as functions: read, import_table, simulate, compare, identify, diagnose, add
and parts; machines by load_model and save_model; and Effect, Parameter and State for effects of one's own.
"""

import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pneumo_ros.api import (
        AddingResult,
        ComparisonResult,
        DiagnosisResult,
        Effect,
        IdentificationResult,
        Model,
        Parameter,
        Recording,
        Result,
        State,
        add,
        compare,
        diagnose,
        identify,
        import_table,
        load_model,
        parts,
        read,
        save,
        save_model,
        simulate,
    )

__version__ = "0.1.0"

__all__ = [
    "AddingResult", "ComparisonResult", "DiagnosisResult", "Effect", "IdentificationResult", "Model", "Parameter",
    "Recording", "Result", "State", "add", "compare", "diagnose", "identify", "import_table", "load_model", "parts",
    "read", "save", "save_model", "simulate",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    """The surface is loaded when it is first used: `pneumo --help` must not wait for numpy."""
    if name not in __all__:
        from pneumo_ros.nearest import unknown_name

        raise AttributeError(f"pneumo_ros: {unknown_name('name', name, __all__)}", name=name, obj=None)
    import importlib

    found = getattr(importlib.import_module("pneumo_ros.api"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted([*__all__, "__doc__", "__version__"])


class _Package(ModuleType):
    """Some rooms have the name of a function, such as compare: `pn.compare` is the function, whoever imports the room.

    `from pneumo_ros.compare.verdicts import SignalError` finds the room all the same.
    """

    def __setattr__(self, name: str, value: object) -> None:
        if not (name in __all__ and isinstance(value, ModuleType)):  # the import system puts a room into its package
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
