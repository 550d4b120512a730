"""C files that come with the package, some with ${names} to fill in."""

from importlib.resources import files
from string import Template


def asset(name: str) -> str:
    """The text of a file of the folder `assets`."""
    return files("pneumo_ros.export").joinpath("assets").joinpath(name).read_text(encoding="utf-8")


def filled(name: str, /, **values: object) -> str:
    """The text of an asset with each ${name} replaced; KeyError for a name without a value."""
    return Template(asset(name)).substitute(values)
