"""modelDescription.xml of a functional mock-up unit, FMI 2.0 and 3.0."""

from xml.etree import ElementTree

from pneumo_ros import __version__
from pneumo_ros.export.machine import Exported
from pneumo_ros.export.si_units import exponents
from pneumo_ros.export.signature import number_text
from pneumo_ros.export.unit_source import MAIN
from pneumo_ros.export.unit_variables import INDICATORS, UnitVariable, unit_variables

Element = ElementTree.Element
_SAMPLE, _DURATION = "0.001", "10.0"  # s, what an importer uses unless told otherwise


def description(machine: Exported, version: int, token: str) -> str:
    """The XML text, for FMI version 2 or 3."""
    rows = unit_variables(machine)
    root = Element("fmiModelDescription", fmiVersion=f"{version}.0", modelName=machine.model.name)
    root.set("instantiationToken" if version == 3 else "guid", token)
    root.set("description", f"pneumatic axis with the effects {', '.join(machine.model.effects) or 'none'}")
    root.set("generationTool", f"pneumo_ros {__version__}")
    root.set("variableNamingConvention", "structured")
    if version == 2:
        root.set("numberOfEventIndicators", str(len(INDICATORS)))
    _add_interfaces(root, machine.prefix, version)
    _add_units(root, rows)
    categories = ElementTree.SubElement(root, "LogCategories")
    ElementTree.SubElement(categories, "Category", name="logStatusError", description="what was refused, and why")
    ElementTree.SubElement(root, "DefaultExperiment", startTime="0.0", stopTime=_DURATION, stepSize=_SAMPLE)
    variables = ElementTree.SubElement(root, "ModelVariables")
    for row in rows:
        (_add_variable_2 if version == 2 else _add_variable_3)(variables, row)
    (_add_structure_2 if version == 2 else _add_structure_3)(ElementTree.SubElement(root, "ModelStructure"), rows)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def build_description(prefix: str) -> str:
    """sources/buildDescription.xml of FMI 3.0."""
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    build = ElementTree.SubElement(root, "BuildConfiguration", modelIdentifier=prefix)
    ElementTree.SubElement(ElementTree.SubElement(build, "SourceFileSet", language="C99"), "SourceFile", name=MAIN)
    ElementTree.SubElement(build, "Library", name="m", external="true", description="mathematical library")
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _add_interfaces(root: Element, prefix: str, version: int) -> None:
    state = "FMUState" if version == 3 else "FMUstate"
    can = {f"canGetAndSet{state}": "true", f"canSerialize{state}": "true"}
    exchange = ElementTree.SubElement(root, "ModelExchange", modelIdentifier=prefix, attrib=can)
    if version == 3:
        exchange.set("needsCompletedIntegratorStep", "true")
    simulation = ElementTree.SubElement(root, "CoSimulation", modelIdentifier=prefix, attrib=can)
    simulation.set("canHandleVariableCommunicationStepSize", "true")
    if version == 2:
        for interface in (exchange, simulation):
            ElementTree.SubElement(ElementTree.SubElement(interface, "SourceFiles"), "File", name=MAIN)


def _add_units(root: Element, rows: list[UnitVariable]) -> None:
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for unit in dict.fromkeys(row.variable.unit for row in rows):
        element, base = ElementTree.SubElement(definitions, "Unit", name=unit), exponents(unit)
        if base is not None:
            ElementTree.SubElement(element, "BaseUnit", {name: str(n) for name, n in base.items()})


def _common(row: UnitVariable) -> dict[str, str]:
    text = {"name": row.name, "valueReference": str(row.reference), "description": row.variable.meaning}
    text |= {"causality": row.causality, "variability": row.variability}
    return {**text, "initial": row.initial} if row.initial else text


def _real(row: UnitVariable) -> dict[str, str]:
    v, size = row.variable, row.size
    text = {"unit": v.unit}
    limits = {"min": v.low, "max": v.high, "nominal": float("inf") if size is None else size}
    text |= {name: number_text(value) for name, value in limits.items() if abs(value) != float("inf")}
    return {**text, "start": number_text(v.start)} if row.initial == "exact" or row.causality == "input" else text


def _add_variable_2(variables: Element, row: UnitVariable) -> None:
    real = _real(row)
    if row.state is not None:
        real["derivative"] = str(row.state + 1)  # counted from 1
    ElementTree.SubElement(ElementTree.SubElement(variables, "ScalarVariable", _common(row)), "Real", real)


def _add_variable_3(variables: Element, row: UnitVariable) -> None:
    derivative = {} if row.state is None else {"derivative": str(row.state)}
    ElementTree.SubElement(variables, "Float64", {**_common(row), **_real(row), **derivative})


def _outputs(rows: list[UnitVariable]) -> list[UnitVariable]:
    return [row for row in rows if row.causality == "output"]


def _slopes(rows: list[UnitVariable]) -> list[UnitVariable]:
    return [row for row in rows if row.state is not None]


def _unknown_at_first(rows: list[UnitVariable]) -> list[UnitVariable]:
    listed = {row.reference for row in (*_outputs(rows), *_slopes(rows)) if row.initial == "calculated"}
    return [row for row in rows if row.reference in listed]


def _add_structure_2(structure: Element, rows: list[UnitVariable]) -> None:
    lists = {"Outputs": _outputs(rows), "Derivatives": _slopes(rows), "InitialUnknowns": _unknown_at_first(rows)}
    for name, listed in lists.items():
        element = ElementTree.SubElement(structure, name)
        for row in listed:
            ElementTree.SubElement(element, "Unknown", index=str(row.reference + 1))


def _add_structure_3(structure: Element, rows: list[UnitVariable]) -> None:
    indicators = [row for row in rows if row.block == "FIRST_INDICATOR"]
    lists = {
        "Output": _outputs(rows), "ContinuousStateDerivative": _slopes(rows),
        "InitialUnknown": _unknown_at_first(rows), "EventIndicator": indicators,
    }  # fmt: skip
    for name, listed in lists.items():
        for row in listed:
            ElementTree.SubElement(structure, name, valueReference=str(row.reference))
