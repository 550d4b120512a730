"""Parameters of a node, declared from data: checked together before any is set; integers count as real numbers."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from math import isfinite
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from pneumo_ros.axis.setting import Setting, Value
from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name

_ROS_OWN = ("use_sim_time", "start_type_description_service")
Values = Mapping[str, Any]


class Parameters:
    """The declared parameters of one node.

    `begun_with` are those from files and command line, which rclpy declared without description; `given` are those of
    them that are not yet declared. A change from outside calls `check` with all new values, which may refuse it with
    UsageError, then `apply`.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._settings: dict[str, Setting] = {}
        self._open = False  # while this class itself declares
        self.check: Callable[[Values], object] = lambda values: None
        self.apply: Callable[[Values], object] = lambda values: None
        names = node.list_parameters([], 0).names
        self.given: dict[str, Any] = {
            name: node.get_parameter(name).value
            for name in names
            if name not in _ROS_OWN and not name.startswith("qos_overrides.")
        }
        self.begun_with: Values = dict(self.given)
        for name in self.given:
            node.undeclare_parameter(name)
        node.add_pre_set_parameters_callback(self._whole_numbers)
        node.add_on_set_parameters_callback(self._validate)
        node.add_post_set_parameters_callback(self._take)

    def choose(self, chosen: Callable[[Values], Values]) -> None:
        """Go on with what `chosen` makes of the parameters from files and command line."""
        self.given = dict(chosen(self.given))
        self.begun_with = dict(self.given)

    def declare(self, settings: Iterable[Setting]) -> None:
        """Declare `settings` with what was given for them, else their defaults.

        Raises UsageError for a value of the wrong type or out of range.
        """
        for setting in settings:
            value = setting.coerce(self.given.pop(setting.name, setting.default))
            self._settings[setting.name] = setting
            with self._declaring():
                self._node.declare_parameter(setting.name, value, descriptor(setting, value), ignore_override=True)

    def undeclare(self, names: Iterable[str]) -> None:
        """Remove live parameters that are no longer used, such as those of a removed effect."""
        for name in names:
            del self._settings[name]
            self._node.undeclare_parameter(name)

    def update(self, values: Values) -> None:
        """Set values from inside the node; `check` and `apply` are not called."""
        with self._declaring():
            self._node.set_parameters_atomically([Parameter(name, value=value) for name, value in values.items()])

    def refuse_unknown(self, tolerated: Callable[[str], bool] = lambda name: False) -> None:
        """Raise UsageError, with the nearest names, if an undeclared parameter was given."""
        for name in self.given:
            if not tolerated(name):
                model = {"axes", "effects"} & {*self.given} and "model" in self._settings
                hint = "; this node takes a machine file as -p model:=my.yaml" if model else ""
                raise UsageError(unknown_name("parameter", name, self._settings) + hint)

    def __getitem__(self, name: str) -> Any:
        return self._node.get_parameter(name).value

    def __contains__(self, name: str) -> bool:
        return name in self._settings

    @property
    def uses_simulated_time(self) -> bool:
        """Whether the node's clock is /clock."""
        return bool(self._node.get_parameter("use_sim_time").value)

    def values(self) -> dict[str, Any]:
        """All values by name."""
        return {name: self._node.get_parameter(name).value for name in self._settings}

    @contextmanager
    def _declaring(self) -> Iterator[None]:
        before, self._open = self._open, True
        try:
            yield
        finally:
            self._open = before

    # --- callbacks of rclpy -----------------------------------------------------------------------------------------

    def _whole_numbers(self, parameters: list[Parameter]) -> list[Parameter]:
        """Convert integers: ROS refuses `mass: 5` for a parameter declared as 5.0."""
        return [self._as_declared(p) for p in parameters]

    def _as_declared(self, parameter: Parameter) -> Parameter:
        setting = self._settings.get(parameter.name)
        if setting is None:
            return parameter
        if type(setting.default) is float and parameter.type_ == Parameter.Type.INTEGER:
            return Parameter(parameter.name, Parameter.Type.DOUBLE, float(parameter.value))
        if isinstance(setting.default, list) and parameter.type_ == Parameter.Type.INTEGER_ARRAY:
            return Parameter(parameter.name, Parameter.Type.DOUBLE_ARRAY, [float(v) for v in parameter.value])
        return parameter

    def _validate(self, parameters: list[Parameter]) -> SetParametersResult:
        if self._open:
            return SetParametersResult(successful=True)
        try:
            changed = {p.name: self._coerced(p) for p in parameters}
            self.check({**self.values(), **changed})
        except UsageError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _coerced(self, parameter: Parameter) -> Any:
        setting = self._settings.get(parameter.name)
        return setting.coerce(parameter.value) if setting else parameter.value

    def _take(self, parameters: list[Parameter]) -> None:
        if not self._open:
            self.apply({p.name: p.value for p in parameters if p.name in self._settings})


def descriptor(setting: Setting, value: Value) -> ParameterDescriptor:
    """The ROS descriptor; `value` is the start value; open ranges are chosen to contain it.

    Ranges are finite, because tuning tools draw sliders from them, and continuous (step 0).
    """
    described = ParameterDescriptor(description=setting.described, read_only=not setting.live)
    if type(setting.default) is float:
        low, high = setting.finite_range(float(value))
        described.floating_point_range = [FloatingPointRange(from_value=low, to_value=high, step=0.0)]
    elif type(setting.default) is int and isfinite(setting.low) and isfinite(setting.high):
        described.integer_range = [IntegerRange(from_value=int(setting.low), to_value=int(setting.high), step=1)]
    if setting.choices:
        described.additional_constraints = f"one of: {', '.join(setting.choices)}"
    return described
