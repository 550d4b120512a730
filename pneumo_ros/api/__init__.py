"""What `import pneumo_ros as pn` offers: the verbs as functions, with results as frozen data that show themselves."""

from pneumo_ros.api.adding import AddingResult, add
from pneumo_ros.api.comparing import ComparisonResult, compare
from pneumo_ros.api.diagnosing import DiagnosisResult, diagnose
from pneumo_ros.api.identifying import IdentificationResult, identify
from pneumo_ros.api.reading import import_table, read, save
from pneumo_ros.api.result import Result
from pneumo_ros.api.shelf import parts
from pneumo_ros.api.simulating import simulate
from pneumo_ros.plant import Effect, Model, Parameter, State, load_model, save_model
from pneumo_ros.records import Recording

__all__ = [
    "AddingResult", "ComparisonResult", "DiagnosisResult", "Effect", "IdentificationResult", "Model", "Parameter",
    "Recording", "Result", "State", "add", "compare", "diagnose", "identify", "import_table", "load_model", "parts",
    "read", "save", "save_model", "simulate",
]  # fmt: skip
