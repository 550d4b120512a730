"""Finding effects by name: the shipped catalogue, installed packages, and files named on the command line.

Nothing is registered. An effect `seal_leak` of the catalogue is the class `SealLeak` of `effects/<room>/seal_leak.py`;
other packages offer theirs under the entry point group `pneumo_ros.effects`.
"""

import copy
import importlib
import sys
from collections.abc import Iterable, Mapping
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from types import ModuleType

from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant.actuator import Actuator
from pneumo_ros.plant.coordinate import Scale, turned
from pneumo_ros.plant.effect import Effect
from pneumo_ros.units import LINE, TURN

_ROOMS = ("valve", "line", "chamber", "motor", "piston", "friction", "sensor")


def _modules(room: str) -> dict[str, str]:
    """Effect name -> module name, from the files in a folder."""
    folder = files("pneumo_ros.plant.effects").joinpath(room)
    names = sorted(file.name for file in folder.iterdir()) if folder.is_dir() else []
    kept = [name[:-3] for name in names if name.endswith(".py") and not name.startswith("_")]
    return {name: f"pneumo_ros.plant.effects.{room}.{name}" for name in kept}


@lru_cache(maxsize=1)
def _catalogue_modules() -> Mapping[str, str]:
    """The same for all effects of the catalogue."""
    return {name: module for room in _ROOMS for name, module in _modules(room).items()}


_FRAME = _modules("frame") | _modules("actuator")
ACTUATORS = tuple(_modules("actuator"))  # of which a machine has one, or none if a measured force drives it
USUAL_ACTUATOR = "chambers"
USUAL_FRAME = ("piston", "air", USUAL_ACTUATOR)
FRAME = ("piston", "air", *ACTUATORS)  # sections that are not part of the effects list


def effects_in(module: ModuleType) -> dict[str, type[Effect]]:
    """The effects a module defines itself, by name."""
    own = (value for value in vars(module).values() if isinstance(value, type) and issubclass(value, Effect))
    return {effect.name: effect for effect in own if effect.__module__ == module.__name__}


def effects_of_file(path: str) -> Mapping[str, type[Effect]]:
    """The effects of a user's Python file (it is executed: name only files you trust), read again after an edit.

    Raises UsageError when the file is missing, does not run, or holds no effect.
    """
    if not Path(path).is_file():
        raise UsageError(f"effects file {path} does not exist")
    return _effects_of_file(str(Path(path).resolve()), Path(path).stat().st_mtime_ns)


@lru_cache(maxsize=32)
def _effects_of_file(path: str, _edited: int) -> Mapping[str, type[Effect]]:
    location = Path(path)
    module = ModuleType(f"pneumo_effects_{location.stem}")
    module.__file__ = str(location)
    sys.modules[module.__name__] = module
    try:
        exec(compile(location.read_bytes(), location, "exec"), vars(module))
    except UsageError as error:
        raise UsageError(f"effects file {path}: {error}") from error
    except Exception as error:  # any error in a user's file becomes a sentence
        raise UsageError(f"effects file {path} does not run: {type(error).__name__}: {error}") from error
    found = effects_in(module)
    if not found:
        raise UsageError(f"effects file {path} defines no subclass of pneumo_ros.plant.effect.Effect")
    return found


@lru_cache(maxsize=1)
def _installed() -> dict[str, type[Effect]]:
    from importlib.metadata import entry_points  # slow to import, and seldom needed

    found = {}
    for point in entry_points(group="pneumo_ros.effects"):
        effect = point.load()
        if not (isinstance(effect, type) and issubclass(effect, Effect)):
            raise UsageError(f"entry point {point.name} of group pneumo_ros.effects is no Effect")
        found[effect.name] = effect
    return found


class Library:
    """The available effects: catalogue, installed packages and the given files; files come first."""

    def __init__(self, effect_files: Iterable[str | Path | type[Effect]] = ()) -> None:
        """Load `effect_files`: paths, or classes. UsageError as `effects_of_file`, or when one redefines an effect."""
        self._own: dict[str, type[Effect]] = {}
        self._scale: Scale | None = None
        for given in effect_files:
            where = f"class {given.__name__}" if isinstance(given, type) else f"effects file {given}"
            found = {given.name: given} if isinstance(given, type) else effects_of_file(str(given))
            for name, effect in found.items():
                if name in _catalogue_modules() or name in FRAME or name in self._own:
                    raise UsageError(f"{where} defines {name}, which is already taken; rename the class")
                self._own[name] = effect

    @property
    def coordinate(self) -> str:
        """Along which coordinate the effects act that it gives."""
        return TURN if self._scale else LINE

    def turning(self, scale: Scale) -> "Library":
        """The same effects for a machine of this scale that turns: in rad, N m and kg m2."""
        other = copy.copy(self)
        other._scale = scale
        return other

    def _along(self, effect: type[Effect]) -> type[Effect]:
        return turned(effect, self._scale) if self._scale else effect

    def names(self) -> tuple[str, ...]:
        """All effect names, sorted."""
        own = {name for name, effect in self._own.items() if not issubclass(effect, Actuator)}
        return tuple(sorted({*_catalogue_modules(), *_installed(), *own}))

    def actuators(self) -> tuple[str, ...]:
        """Names of all actuators: the shipped ones, then those of the given files."""
        return (*ACTUATORS, *(name for name, effect in self._own.items() if issubclass(effect, Actuator)))

    def find(self, name: str) -> type[Effect]:
        """The effect of that name; UsageError with the nearest names."""
        if name in self.actuators():
            raise UsageError(
                f"{name} is what actuates the machine: give the machine file a section '{name}', and leave it out of "
                "'effects'"
            )
        if name in self._own:
            return self._along(self._own[name])
        if name in _catalogue_modules():
            return self._along(effects_in(importlib.import_module(_catalogue_modules()[name]))[name])
        if name in _installed():
            return self._along(_installed()[name])
        raise UsageError(f"{unknown_name('effect', name, self.names())} (effects of your own: --effects FILE.py)")

    def part(self, name: str) -> type[Effect]:
        """Piston, air, or an actuator by its name."""
        return self._along(self._own[name] if name in self._own else self.frame(name))

    def actuator(self, name: str) -> type[Actuator]:
        """An actuator by its name."""
        found = self.part(name)
        assert issubclass(found, Actuator), name
        return found

    @staticmethod
    def frame(name: str) -> type[Effect]:
        """Piston, air, or one of the shipped actuators."""
        return effects_in(importlib.import_module(_FRAME[name]))[name]


def is_part(effect: type[Effect]) -> bool:
    """Whether an effect belongs to the frame of a machine, not to its effects list."""
    return effect.name in FRAME or issubclass(effect, Actuator)
