"""Machine files: one YAML file is the model of the commands and the ROS parameter file of the nodes."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

from pneumo_ros.errors import DataError, UsageError, brief
from pneumo_ros.files import write_whole, yaml_number
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant.axes_section import one_axis, place_of
from pneumo_ros.plant.effect import Effect
from pneumo_ros.plant.library import FRAME, Library
from pneumo_ros.plant.model import Model
from pneumo_ros.plant.uncertainty import SECTION, flat, nested
from pneumo_ros.units import KEY, LINE
from pneumo_ros.yaml_text import load_yaml


def shipped_machines() -> tuple[str, ...]:
    """Names of the machine files that come with the package."""
    return tuple(sorted(f.name[:-5] for f in files("pneumo_ros.config").iterdir() if f.name.endswith(".yaml")))


def read_machine(name_or_path: str | Path) -> tuple[str, str]:
    """Name and text of a machine file: a path, or the name of a shipped one (`axis`, `paper`).

    Of two.yaml:shoulder, the file. Raises DataError when there is none, or it cannot be read.
    """
    name_or_path = place_of(name_or_path)[0]
    path = Path(name_or_path)
    shipped = files("pneumo_ros.config").joinpath(f"{name_or_path}.yaml")
    try:
        if not path.is_file() and path.name == str(name_or_path) and shipped.is_file():
            return path.name, shipped.read_text(encoding="utf-8")
        return path.stem, path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        text = "it is no UTF-8 text" if isinstance(error, UnicodeDecodeError) else "that is not a file name"
        reason = error.strerror if isinstance(error, OSError) else text
        raise DataError(
            f"machine file {name_or_path} cannot be read ({reason}); "
            f"give a YAML file or one of: {', '.join(shipped_machines())}"
        ) from error


def load_model(name_or_path: str | Path = "axis", effects_files: Iterable[str | Path | type[Effect]] = ()) -> Model:
    """Load a machine file, completely or not at all.

    `name_or_path`: a path, or the name of a shipped one, `axis`, `paper`, `emps` or `vane`; of a file with several
    axes, one is meant by two.yaml:shoulder. `effects_files`: effects of your own, as paths of Python files or as
    classes.

    Raises DataError when the file cannot be read, and UsageError, with the nearest names, for an unknown or missing
    section, effect or parameter, or a value that is no finite number within its range.
    """
    path, axis = place_of(name_or_path)
    name, text = read_machine(path)
    try:
        given, folder = one_axis(sections_of(text), path, axis), folder_of(path)
        return model_from_dict(given, f"{name}:{axis}" if axis else name, Library(effects_files), folder)
    except UsageError as error:
        raise UsageError(f"machine file {name_or_path}: {error}") from error


def parse_machine(text: str, name: str, library: Library, folder: Path = Path()) -> Model:
    """The model of a machine file's text; a URDF that it names lies in `folder`. UsageError as for `load_model`."""
    return model_from_dict(sections_of(text), name, library, folder)


def folder_of(name_or_path: str | Path) -> Path:
    """The folder in which a machine file's URDF lies; the present one for shipped machines."""
    place = Path(name_or_path)
    return place.parent if place.is_file() else Path()


def sections_of(text: str) -> dict[str, Any]:
    """The sections in a machine file's text, of one axis or several; UsageError for other text."""
    return _parameters(load_yaml(text))


def _parameters(document: object) -> dict[str, Any]:
    """Sections of a machine file, or of the `ros2 param dump` of a simulator."""
    layout = "the first lines must read '/**:', '  ros__parameters:', '    effects: [...]'"
    if not isinstance(document, dict) or not isinstance(document.get("/**"), dict):
        if dumped := _dumped(document):
            return dumped
        raise UsageError(f"no section '/**'; {layout} (or the file is a ros2 param dump of a simulator)")
    parameters = document["/**"].get("ros__parameters")
    if not isinstance(parameters, dict):
        raise UsageError(f"no section 'ros__parameters' in '/**'; {layout}")
    return parameters


def _dumped(document: object) -> dict[str, Any] | None:
    """Sections of the machine in a `ros2 param dump`, which begins with the name of the node; None if it is none."""
    nodes = document.items() if isinstance(document, dict) else ()
    inner = {str(name): one["ros__parameters"] for name, one in nodes if _holds(one, "ros__parameters")}
    machines = {name: given for name, given in inner.items() if _holds(given, "effects")}
    if len(machines) > 1:
        raise UsageError(f"it holds {len(machines)} machines ({', '.join(machines)}); keep one of them in a file")
    return next((_of_the_machine(given) for given in machines.values()), None)


def _holds(content: object, key: str) -> bool:
    return isinstance(content, dict) and key in content


def _of_the_machine(given: Mapping[str, Any]) -> dict[str, Any]:
    """A node's parameters without those that are its own: rates, names, seeds, effects that were switched off."""
    listed = given["effects"] if isinstance(given["effects"], list) else []
    kept = {"effects", KEY, SECTION, *FRAME, *(name for name in listed if isinstance(name, str))}
    machine = {name: value for name, value in given.items() if name in kept}
    if "mass_0" in (arm := machine.get("arm_load", {})):  # the coefficients are those of its URDF already
        machine["arm_load"] = {key: value for key, value in arm.items() if key.startswith(("mass_", "energy_"))}
    return machine


def model_from_dict(given: Mapping[str, Any], name: str, library: Library, folder: Path = Path()) -> Model:
    """A model from the nested dictionary of a machine file (also what `description` carries); UsageError as above.

    A section `arm_load` that names a URDF, relative to `folder`, is replaced by its coefficients.
    """
    listed = given.get("effects")
    if not isinstance(listed, list) or not all(isinstance(item, str) for item in listed):
        raise UsageError(f"'effects' is {brief(listed)}; it takes a list of names, such as [dead_zone, arctan_flow]")
    listed = [name for name in listed if name]
    sections = {key: value for key, value in given.items() if key not in ("effects", KEY, SECTION)}
    frame = _frame(sections, library)
    known = [*frame, *listed]
    for section, values in sections.items():
        if section not in known:
            hint = "; add it to 'effects' if you want it" if section in library.names() else ""
            raise UsageError(f"{unknown_name('section', str(section), {*known, 'air', *library.actuators()})}{hint}")
        if not isinstance(values, dict):
            raise UsageError(f"section {section} is {brief(values)}; it takes its parameters, name: value")
    if "urdf" in sections.get("arm_load", {}):
        from pneumo_ros.plant.arm_section import coefficients  # Pinocchio is optional, and seldom needed

        sections["arm_load"] = coefficients(sections["arm_load"], sections.get("piston", {}).get("stroke"), folder)
    values = {f"{section}.{key}": _number(v) for section, inner in sections.items() for key, v in inner.items()}
    uncertainty = flat(given[SECTION]) if SECTION in given else {}
    return Model.build(
        listed, values, name=name, library=library, frame=frame, uncertainty=uncertainty, coordinate=given.get(KEY)
    )


def _frame(sections: Collection[str], library: Library) -> tuple[str, ...]:
    """The parts that are not effects: piston, air, and what actuates the machine; UsageError for two actuators."""
    actuators = [name for name in library.actuators() if name in sections]
    if len(actuators) > 1:
        raise UsageError(
            f"sections {' and '.join(actuators)} each say what actuates the machine; a machine file has one of "
            f"{', '.join(library.actuators())}, or none if a measured force drives the machine"
        )
    return ("piston", "air", *actuators) if actuators else ("piston", *(["air"] if "air" in sections else []))


def _number(value: object) -> object:
    """YAML 1.1 reads 7e5 as text, ROS reads a number: text that is a number becomes that number."""
    if isinstance(value, str):
        try:
            return float(value)
        except ValueError:
            return value
    return value


def machine_text(model: Model, notes: Mapping[str, str] | None = None) -> str:
    """The machine file of a model, with unit and meaning beside every value, and `notes` by dotted name."""
    effects = ", ".join(model.effects) or '""'  # ROS cannot know the type of an empty list
    lines = ["/**:", "  ros__parameters:", f"    effects: [{effects}]"]
    if model.coordinate != LINE:
        lines.append(f"    {KEY}: {model.coordinate}  # in rad, N m and kg m2")
    section = ""
    for dotted, value in model.parameters.items():
        owner, _, key = dotted.partition(".")
        if owner != section:
            lines.append(f"    {owner}:")
            section = owner
        note = f"; {notes[dotted]}" if notes and dotted in notes else ""
        lines.append(f"      {key}: {yaml_number(value)}  # {_unit(model, dotted)}{_meaning(model, dotted)}{note}")
    return "\n".join([*lines, *_uncertain(model)]) + "\n"


def _uncertain(model: Model) -> Iterator[str]:
    """Lines of the section that states the uncertainty of values, if there is any."""
    if model.uncertainty:
        yield f"    {SECTION}:  # standard deviations of what is not known exactly: priors of fits"
    for section, inner in nested(model.uncertainty).items():
        yield f"      {section}:"
        for key, value in inner.items():
            yield f"        {key}: {yaml_number(value)}  # {_unit(model, f'{section}.{key}')}".rstrip("# ")


def _unit(model: Model, dotted: str) -> str:
    unit = model.specification(dotted).unit
    return "" if unit == "1" else f"[{unit}] "


def _meaning(model: Model, dotted: str) -> str:
    return model.specification(dotted).meaning


def save_model(model: Model, path: str | Path, *, overwrite: bool = True) -> Path:
    """Write the machine file of `model` to `path`, whole or not at all; returns the path.

    Raises DataError when the file exists and `overwrite` is false, UsageError when it cannot be written.
    """
    target = Path(path)
    if target.exists() and not overwrite:
        raise DataError(f"{target} exists and is kept; name another file")
    write_whole(target, machine_text(model))
    return target
