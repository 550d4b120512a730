"""What the machine does: effects, their composition into one compiled kernel, and machine files."""

from pneumo_ros.plant.effect import Effect, Parameter, State
from pneumo_ros.plant.library import Library
from pneumo_ros.plant.machine_file import load_model, model_from_dict, save_model
from pneumo_ros.plant.model import Model
from pneumo_ros.plant.stepper import Stepper

__all__ = ["Effect", "Library", "Model", "Parameter", "State", "Stepper", "load_model", "model_from_dict", "save_model"]
