from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, TypedDict, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
Floats = NDArray[np.float64]
Measures = str | Sequence[str]
Path = str | PathLike[str]
AtKinks = Literal["left", "right", "mean"] | None
Progress = bool | Callable[[float, str], object]

class InvalidParameter(ValueError):
    key: str
    value: Any
    expected: str
    def __init__(self, key: str, value: Any, expected: str) -> None: ...
    @property
    def others(self) -> list[str]: ...

class InvalidDefinition(ValueError): ...

class Failed(RuntimeError):
    what: str
    reason: str
    def __init__(self, what: str, reason: str) -> None: ...

class KinkWarning(UserWarning):
    measure: str
    key: str
    left: float
    right: float
    change: str
    def __init__(self, measure: str, key: str, left: float, right: float, change: str) -> None: ...

class CheckWarning(UserWarning): ...

class FoldWarning(UserWarning):
    fold_force: float
    def __init__(self, fold_force: float) -> None: ...

class Table(Mapping[str, NDArray[Any]]):
    units: dict[str, str]
    meanings: dict[str, str]
    def __getitem__(self, name: str) -> NDArray[Any]: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    @property
    def rows(self) -> int: ...
    def row(self, index: int) -> dict[str, Any]: ...
    def to_pandas(self) -> Any: ...
    def __arrow_c_stream__(self, requested_schema: object = None) -> object: ...

class Run(Table):
    folder: str
    skin: Skin | None
    failed_checks: list[str]
    def __init__(self, folder: Path) -> None: ...
    def rank(
        self,
        require: str | Iterable[str] = (),
        maximize: str | Iterable[str] = (),
        minimize: str | Iterable[str] = (),
        weights: Sequence[float] | None = None,
    ) -> Table: ...
    def report(self, out: Path | None = None) -> str: ...

class Requirement(TypedDict):
    requirement: str
    value: float | None
    limit: float
    margin: float | None

class Answer(TypedDict):
    requirements: list[Requirement]
    warnings: list[str]

class Result:
    skin: Skin
    status: str
    warnings: list[str]
    path: Table
    events: Table
    scales: Table
    steps: Table
    way_back: Table
    places: Table
    flexure_path: Table
    flexure_events: Table
    flexure_scales: Table
    flexure_steps: Table
    flexure_way_back: Table
    sensitivity: Table
    @property
    def values(self) -> dict[str, float | int | str | None]: ...
    @property
    def units(self) -> dict[str, str]: ...
    @property
    def meanings(self) -> dict[str, str]: ...
    def __getitem__(self, name: str) -> Any: ...
    def keys(self) -> list[str]: ...
    def get(self, name: str, default: Any = ...) -> Any: ...
    def answer(self, require: str | Iterable[str] = ()) -> Answer: ...
    def plot(self, axes: Any = None) -> Any: ...

@overload
def function(
    skin: Skin, keys: Iterable[str], measures: str, at_kinks: AtKinks = None
) -> tuple[Callable[[ArrayLike], float], Callable[[ArrayLike], Floats]]: ...
@overload
def function(
    skin: Skin, keys: Iterable[str], measures: list[str] | tuple[str, ...], at_kinks: AtKinks = None
) -> tuple[Callable[[ArrayLike], Floats], Callable[[ArrayLike], Floats]]: ...
def solve_many(
    skins: Skin | Iterable[Skin], measures: Measures = "all", *, threads: int | None = None, progress: Progress = False
) -> Table: ...
def read(folder: Path) -> Run: ...
def run(
    definition: Path | Skin,
    out: Path | None = None,
    *,
    set: Mapping[str, Any] | None = None,
    resume: bool = False,
    fresh: bool = False,
    threads: int | None = None,
    progress: Progress = False,
) -> Run: ...
def optimise(
    goal: Path,
    out: Path | None = None,
    *,
    set: Mapping[str, Any] | None = None,
    resume: bool = False,
    fresh: bool = False,
    threads: int | None = None,
    progress: Progress = False,
) -> Run: ...
def tolerance(
    definition: Path | Skin,
    *,
    set: Mapping[str, Any] | None = None,
    require: str | Iterable[str] = (),
    samples: int = 1000,
    out: Path | None = None,
    threads: int | None = None,
    progress: Progress = False,
) -> dict[str, Table]: ...

# Made from the list of parameters by `python -m squama._manual __init__.pyi`.
class Skin:
    def __init__(
        self,
        *,
        gap_over_t: float | None = None,
        gap_mm: float | None = None,
        length_over_t: float | None = None,
        length_mm: float | None = None,
        pitch_mm: float | None = None,
        slant_deg: float,
        base: str | None = None,
        width_over_t: float | None = None,
        width_mm: float | None = None,
        bending: str | None = None,
        poisson_ratio: float | None = None,
        tissue_thickness_over_t: float | None = None,
        tissue_thickness_mm: float | None = None,
        coupling: str | None = None,
        law: str | None = None,
        curvature_times_t: float | None = None,
        radius_over_t: float | None = None,
        radius_mm: float | None = None,
        radius_to_over_t: float | None = None,
        radius_to_mm: float | None = None,
        c1: float | None = None,
        c2: float | None = None,
        friction: float | None = None,
        scales: int | str | None = None,
        load_position: float | None = None,
        load_inset_over_t: float | None = None,
        load_inset_mm: float | None = None,
        needle: str | None = None,
        needle_radius_over_t: float | None = None,
        needle_radius_mm: float | None = None,
        unload: bool | None = None,
        critical_tilt_deg: float | Sequence[float] | None = None,
        needle_friction: float | Sequence[float] | str | None = None,
        depth_over_t: float | None = None,
        depth_mm: float | None = None,
        force_over_substrate: float | None = None,
        force_N: float | None = None,
        places: int | str | None = None,
        contact_modulus_over_substrate: float | None = None,
        failure: bool | None = None,
        scale_strength_over_substrate: float | None = None,
        bond_strength_over_substrate: float | None = None,
        across: bool | None = None,
        gap_across_over_t: float | None = None,
        gap_across_mm: float | None = None,
        method: str | None = None,
        membrane_length_over_t: float | None = None,
        membrane_length_mm: float | None = None,
        gaps: int | str | None = None,
        membrane_thickness_over_t: float | None = None,
        membrane_thickness_mm: float | None = None,
        membrane_axis_offset_over_t: float | None = None,
        membrane_axis_offset_mm: float | None = None,
        elements_per_gap: int | str | None = None,
        unbend: bool | None = None,
        max_end_rotation_deg: float | None = None,
        contact_modulus_over_membrane: float | None = None,
        gap_cv: float | None = None,
        slant_sd_deg: float | None = None,
        samples: int | None = None,
        seed: int | None = None,
        first_step: float | None = None,
        max_step: float | None = None,
        min_step: float | None = None,
        tolerance: float | None = None,
        max_iterations: int | None = None,
        max_points: int | None = None,
        thickness_mm: float | None = None,
        substrate_modulus_MPa: float | None = None,
        membrane_modulus_MPa: float | None = None,
        scale_modulus_MPa: float | None = None,
        scale_strength_MPa: float | None = None,
        bond_strength_MPa: float | None = None,
        scale_density_kg_m3: float | None = None,
        scale: str | None = None,
        tissue: str | None = None,
        body: str | None = None,
    ) -> None: ...
    @property
    def gap_over_t(self) -> float: ...
    @property
    def gap_mm(self) -> float | None: ...
    @property
    def length_over_t(self) -> float: ...
    @property
    def length_mm(self) -> float | None: ...
    @property
    def pitch_mm(self) -> float | None: ...
    @property
    def slant_deg(self) -> float: ...
    @property
    def base(self) -> str: ...
    @property
    def width_over_t(self) -> float: ...
    @property
    def width_mm(self) -> float | None: ...
    @property
    def bending(self) -> str: ...
    @property
    def poisson_ratio(self) -> float: ...
    @property
    def tissue_thickness_over_t(self) -> float | None: ...
    @property
    def tissue_thickness_mm(self) -> float | None: ...
    @property
    def coupling(self) -> str: ...
    @property
    def law(self) -> str: ...
    @property
    def curvature_times_t(self) -> float: ...
    @property
    def radius_over_t(self) -> float | None: ...
    @property
    def radius_mm(self) -> float | None: ...
    @property
    def radius_to_over_t(self) -> float | None: ...
    @property
    def radius_to_mm(self) -> float | None: ...
    @property
    def c1(self) -> float: ...
    @property
    def c2(self) -> float: ...
    @property
    def friction(self) -> float: ...
    @property
    def scales(self) -> int | str: ...
    @property
    def load_position(self) -> float: ...
    @property
    def load_inset_over_t(self) -> float | None: ...
    @property
    def load_inset_mm(self) -> float | None: ...
    @property
    def needle(self) -> str: ...
    @property
    def needle_radius_over_t(self) -> float | None: ...
    @property
    def needle_radius_mm(self) -> float | None: ...
    @property
    def unload(self) -> bool: ...
    @property
    def critical_tilt_deg(self) -> float | Sequence[float]: ...
    @property
    def needle_friction(self) -> float | Sequence[float] | str: ...
    @property
    def depth_over_t(self) -> float | None: ...
    @property
    def depth_mm(self) -> float | None: ...
    @property
    def force_over_substrate(self) -> float | None: ...
    @property
    def force_N(self) -> float | None: ...
    @property
    def places(self) -> int | str: ...
    @property
    def contact_modulus_over_substrate(self) -> float: ...
    @property
    def failure(self) -> bool: ...
    @property
    def scale_strength_over_substrate(self) -> float | None: ...
    @property
    def bond_strength_over_substrate(self) -> float | None: ...
    @property
    def across(self) -> bool: ...
    @property
    def gap_across_over_t(self) -> float | None: ...
    @property
    def gap_across_mm(self) -> float | None: ...
    @property
    def method(self) -> str: ...
    @property
    def membrane_length_over_t(self) -> float: ...
    @property
    def membrane_length_mm(self) -> float | None: ...
    @property
    def gaps(self) -> int | str: ...
    @property
    def membrane_thickness_over_t(self) -> float: ...
    @property
    def membrane_thickness_mm(self) -> float | None: ...
    @property
    def membrane_axis_offset_over_t(self) -> float: ...
    @property
    def membrane_axis_offset_mm(self) -> float | None: ...
    @property
    def elements_per_gap(self) -> int | str: ...
    @property
    def unbend(self) -> bool: ...
    @property
    def max_end_rotation_deg(self) -> float: ...
    @property
    def contact_modulus_over_membrane(self) -> float: ...
    @property
    def gap_cv(self) -> float: ...
    @property
    def slant_sd_deg(self) -> float: ...
    @property
    def samples(self) -> int: ...
    @property
    def seed(self) -> int: ...
    @property
    def first_step(self) -> float: ...
    @property
    def max_step(self) -> float: ...
    @property
    def min_step(self) -> float: ...
    @property
    def tolerance(self) -> float: ...
    @property
    def max_iterations(self) -> int: ...
    @property
    def max_points(self) -> int: ...
    @property
    def thickness_mm(self) -> float | None: ...
    @property
    def substrate_modulus_MPa(self) -> float | None: ...
    @property
    def membrane_modulus_MPa(self) -> float | None: ...
    @property
    def scale_modulus_MPa(self) -> float | None: ...
    @property
    def scale_strength_MPa(self) -> float | None: ...
    @property
    def bond_strength_MPa(self) -> float | None: ...
    @property
    def scale_density_kg_m3(self) -> float | None: ...
    @property
    def parameters(self) -> dict[str, Any]: ...
    @property
    def failure_modes(self) -> dict[str, str | None] | None: ...
    @staticmethod
    def from_toml(definition: str | PathLike[str], design: int | None = None) -> Skin: ...
    @staticmethod
    def all_from_toml(definition: str | PathLike[str]) -> list[Skin]: ...
    def to_toml(self) -> str: ...
    def replace(self, **parameters: Any) -> Skin: ...
    def solve(self, measures: Measures = "all") -> Result: ...
    def value_and_gradient(
        self, measure: str, keys: Iterable[str], at_kinks: AtKinks = None
    ) -> tuple[float, Floats]: ...
