"""Promises of the public functions themselves: documented, annotated, and no misspelt keyword swallowed."""

import importlib
import inspect
import pkgutil
from collections.abc import Callable, Iterator
from typing import Any

import pytest

import pneumo_ros

PURE = ("plant", "records", "control", "identify", "diagnose", "command", "workbench")


def public_modules() -> Iterator[str]:
    """Names of all modules but the nodes, whose callbacks belong to rclpy."""
    for found in pkgutil.walk_packages(pneumo_ros.__path__, "pneumo_ros."):
        parts = found.name.split(".")
        if parts[1] not in ("ros", "__main__") and not any(part.startswith("_") for part in parts[1:]):
            yield found.name


def public_members(module: Any) -> Iterator[tuple[str, Any]]:
    """Public classes and functions that a module defines itself."""
    for name, member in vars(module).items():
        if not name.startswith("_") and getattr(member, "__module__", None) == module.__name__:
            yield name, member


def is_effect(member: Any) -> bool:
    """Effects are equations, not functions to call: their arguments are signals of one table."""
    from pneumo_ros.plant.effect import Effect

    return inspect.isclass(member) and issubclass(member, Effect)


def callables() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Every public function, and every public method written in this package."""
    for module_name in public_modules():
        module = importlib.import_module(module_name)
        for name, member in public_members(module):
            if inspect.isfunction(member):
                yield f"{module_name}.{name}", member
            elif inspect.isclass(member) and not is_effect(member):
                for method, function in vars(member).items():
                    inner = getattr(function, "__func__", function)
                    written = inspect.isfunction(inner) and inner.__qualname__ == f"{member.__qualname__}.{method}"
                    # dataclasses and named tuples write __init__ and its like themselves, from annotated fields
                    if written and (method == "__init__" or not method.startswith("_")) and _has_source(inner):
                        yield f"{module_name}.{name}.{method}", inner


def _has_source(function: Callable[..., Any]) -> bool:
    return not function.__code__.co_filename.startswith("<")


CALLABLES = dict(callables())
CLASSES = {
    f"{module}.{name}": member
    for module in public_modules()
    for name, member in public_members(importlib.import_module(module))
    if inspect.isclass(member)
}


def test_there_is_something_to_check() -> None:
    rooms = {name.split(".")[1] for name in CALLABLES}
    assert {"plant", "records", "command"} <= rooms


@pytest.mark.parametrize("name", sorted(CALLABLES))
def test_arguments_and_result_are_annotated(name: str) -> None:
    signature = inspect.signature(CALLABLES[name])
    bare = [
        parameter.name
        for parameter in signature.parameters.values()
        if parameter.annotation is parameter.empty and parameter.name not in ("self", "cls")
    ]
    assert not bare, f"{name}: arguments without annotation: {bare}"
    assert signature.return_annotation is not signature.empty, f"{name}: result without annotation"


@pytest.mark.parametrize("name", sorted(CALLABLES))
def test_is_documented(name: str) -> None:
    function = CALLABLES[name]
    # __init__ speaks through its class; a method that overrides inherits what it promises
    if not name.endswith(".__init__"):
        assert (inspect.getdoc(function) or "").strip(), f"{name} has no docstring"


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_class_is_documented(name: str) -> None:
    written = CLASSES[name].__doc__ or ""
    assert written.strip(), f"{name} has no docstring"
    assert not written.startswith(f"{CLASSES[name].__name__}("), f"{name} has only the docstring dataclasses make up"


@pytest.mark.parametrize("name", sorted(CALLABLES))
def test_no_misspelt_keyword_is_swallowed(name: str) -> None:
    """`**anything` accepts every misspelling in silence; those who need it must refuse an unknown name themselves."""
    catch_all = [p.name for p in inspect.signature(CALLABLES[name]).parameters.values() if p.kind is p.VAR_KEYWORD]
    if catch_all:
        with pytest.raises((pneumo_ros_errors().UsageError, TypeError)):
            call_with_unknown_keyword(name)


def pneumo_ros_errors() -> Any:
    """The error classes, imported late so that collection fails in one place only."""
    return importlib.import_module("pneumo_ros.errors")


def call_with_unknown_keyword(name: str) -> None:
    """Call a function that takes `**anything` with a keyword nobody can mean."""
    owner = name.rpartition(".")[0]
    if owner == "pneumo_ros.plant.model.Model":
        from pneumo_ros.plant import load_model

        getattr(load_model("axis"), name.rpartition(".")[2])(no_such_keyword=1.0)
    else:
        CALLABLES[name](no_such_keyword=1.0)
