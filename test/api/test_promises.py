"""Public functions: documented, annotated, and no misspelt keyword is ignored."""

import importlib
import inspect
import pkgutil
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import pneumo_ros
from pneumo_ros.errors import UsageError


@cache
def modules() -> list[Any]:
    """All public modules but the nodes, whose callbacks belong to rclpy."""
    names = (found.name for found in pkgutil.walk_packages(pneumo_ros.__path__, "pneumo_ros."))
    return [importlib.import_module(name) for name in names if is_public(name.split(".")[1:])]


def is_public(parts: list[str]) -> bool:
    """Whether a module may be imported by users."""
    return parts[0] not in ("ros", "__main__") and not any(part.startswith("_") for part in parts)


def public_members(module: Any) -> Iterator[tuple[str, Any]]:
    """Public classes and functions that a module defines itself."""
    for name, member in vars(module).items():
        if not name.startswith("_") and getattr(member, "__module__", None) == module.__name__:
            yield name, member


def is_effect(member: Any) -> bool:
    """Effects are equations, not functions to call: their arguments are signals of one table."""
    from pneumo_ros.plant.effect import Effect

    return inspect.isclass(member) and issubclass(member, Effect)


@cache
def callables() -> dict[str, Callable[..., Any]]:
    """Every public function, and every public method written in this package, by its full name."""
    found = {}
    for module in modules():
        for name, member in public_members(module):
            if inspect.isfunction(member):
                found[f"{module.__name__}.{name}"] = member
            elif inspect.isclass(member) and not is_effect(member):
                methods = {f"{module.__name__}.{name}.{key}": inner for key, inner in written_methods(member)}
                found.update(methods)
    return found


def written_methods(owner: type) -> Iterator[tuple[str, Callable[..., Any]]]:
    """Public methods in the source of a class; dataclasses generate others from annotated fields."""
    for name, function in vars(owner).items():
        inner = getattr(function, "__func__", function)
        own = inspect.isfunction(inner) and inner.__qualname__ == f"{owner.__qualname__}.{name}"
        if own and (name == "__init__" or not name.startswith("_")) and has_source(inner):
            yield name, inner


def has_source(function: Callable[..., Any]) -> bool:
    """Whether a file holds the function."""
    return not function.__code__.co_filename.startswith("<")


def classes() -> dict[str, type]:
    """Every public class by its full name."""
    return {f"{m.__name__}.{name}": one for m in modules() for name, one in public_members(m) if inspect.isclass(one)}


def test_all_rooms_are_looked_at() -> None:
    rooms = {name.split(".")[1] for name in callables()}
    assert {"plant", "records", "control", "identify", "diagnose", "command", "workbench"} <= rooms
    assert len(callables()) > 1000
    assert len(classes()) > 100


def test_arguments_and_results_are_annotated() -> None:
    bare = []
    for name, function in callables().items():
        signature = inspect.signature(function)
        arguments = [p for p in signature.parameters.values() if p.name not in ("self", "cls")]
        bare += [f"{name}: {p.name}" for p in arguments if p.annotation is p.empty]
        bare += [f"{name}: result"] if signature.return_annotation is signature.empty else []
    assert not bare


def test_functions_are_documented() -> None:
    """`__init__` is described by its class; a method that overrides another inherits its docstring."""
    found = callables().items()
    assert not [name for name, function in found if not name.endswith(".__init__") and not inspect.getdoc(function)]


def test_classes_are_documented() -> None:
    """The generated docstring of a dataclass is not enough."""
    bare = [name for name, one in classes().items() if not (one.__doc__ or "").strip()]
    made_up = [name for name, one in classes().items() if (one.__doc__ or "").startswith(f"{one.__name__}(")]
    assert not bare + made_up


def test_no_misspelt_keyword_is_swallowed() -> None:
    """`**anything` silently accepts every misspelling; functions that need it must refuse an unknown name."""
    kinds = {name: [p.kind for p in inspect.signature(one).parameters.values()] for name, one in callables().items()}
    catching = [name for name, found in kinds.items() if inspect.Parameter.VAR_KEYWORD in found]
    assert not [name for name in catching if not refuses_unknown_keyword(name)]


def refuses_unknown_keyword(name: str) -> bool:
    """Whether a function that takes `**anything` says so when a name is unknown."""
    try:
        call_with_unknown_keyword(name)
    except (UsageError, TypeError):
        return True
    return False


def call_with_unknown_keyword(name: str) -> None:
    """Call a function that takes `**anything` with an unknown keyword."""
    owner = name.rpartition(".")[0]
    if owner == "pneumo_ros.plant.model.Model":
        from pneumo_ros.plant import load_model

        getattr(load_model("axis"), name.rpartition(".")[2])(no_such_keyword=1.0)
    else:
        callables()[name](no_such_keyword=1.0)
