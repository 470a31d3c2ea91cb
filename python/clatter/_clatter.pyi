"""The functions of Rust, which the modules beside this one name, check and document."""

from collections.abc import Sequence
from typing import Any

from numpy import float64
from numpy.typing import NDArray

__version__: str

_Floats = NDArray[float64]
_Some = _Floats | None
_Answered = tuple[str, Drawing | None]
_Numbers = Sequence[float]
_Pair = Sequence[float]
_Which = str | int
_Ratio = float | Sequence[float] | None
_Given = tuple[
    Sequence[tuple[float, str | None]] | None,
    Sequence[tuple[float, float, float]] | None,
    _Numbers | None,
    Sequence[tuple[Record, float]],
]

class Drawing:
    def svg(self) -> str: ...

class PulseData:
    shape: str
    amplitude_m_s2: float
    duration_s: float
    start_s: float
    velocity_change_m_s: float
    def __init__(self, shape_name: str, amplitude_m_s2: float, duration_s: float, start_s: float) -> None: ...
    @staticmethod
    def of_standard(keyword: str) -> PulseData: ...

class ProductText:
    warnings: str
    def __init__(self, text: str, origin: str) -> None: ...

class Record:
    file: str
    channels: list[tuple[str, str]]
    step_s: float | None
    findings: list[str]
    @staticmethod
    def open(
        path: str,
        time: _Which | None,
        acceleration: Sequence[_Which],
        units: str | None,
        sample_rate_hz: float | None,
        full_scale_m_s2: float | None,
        sensitivity: str | None,
        sensor: str | None,
        record: int | None,
        skip_bad: bool,
    ) -> Record: ...
    @staticmethod
    def of_columns(
        columns: Sequence[tuple[str, str | None, NDArray[Any]]],
        left_out: Sequence[str],
        file: str,
        time: _Which | None,
        acceleration: Sequence[_Which],
        units: str | None,
        sample_rate_hz: float | None,
        full_scale_m_s2: float | None,
        sensitivity: str | None,
        skip_bad: bool,
    ) -> Record: ...
    def values_m_s2(self, index: int) -> _Floats: ...
    def times_s(self, index: int) -> _Floats: ...
    def window(self, from_s: float, to_s: float) -> Record: ...
    def detrend(self, baseline: str) -> Record: ...
    def filter(self, high: bool, hz: float) -> Record: ...
    def describe(
        self,
        find: bool,
        threshold_m_s2: float | None,
        quiet_s: float,
        fit_pulse: bool,
        nominal: PulseData | None,
        integrate: bool,
    ) -> _Answered: ...

def impacts(
    e: float,
    q: float | None = ...,
    gyration_ratio: _Ratio = ...,
    center_of_mass: _Ratio = ...,
    masses: Sequence[tuple[float, ...]] | None = ...,
    velocity: _Numbers | None = ...,
    height_gap: _Ratio = ...,
    at: Sequence[float] | Sequence[tuple[float, float]] | None = ...,
    limit: int = ...,
) -> _Answered: ...
def zone(
    e: float,
    threshold: _Numbers,
    q: float | None = ...,
    gyration_ratio: _Ratio = ...,
    center_of_mass: _Ratio = ...,
    masses: Sequence[tuple[float, ...]] | None = ...,
    first: str | None = ...,
    height_gap: _Pair | None = ...,
) -> _Answered: ...
def atlas(e: float, gyration_ratio: _Ratio, center_of_mass: _Ratio = ..., limit: int = ...) -> _Answered: ...
def map(
    quantity: str,
    e: tuple[float, float, int],
    q: tuple[float, float, int] | None = ...,
    gyration_ratio: tuple[float, float, int] | None = ...,
    threshold: float | None = ...,
) -> tuple[_Floats, _Floats, _Floats, Drawing]: ...
def bars(
    shape: Sequence[int],
    q: _Some,
    gyration_ratio: _Some,
    center_of_mass: _Some,
    e: _Floats,
    velocity: Sequence[_Floats],
    height_gap: _Floats,
) -> dict[str, _Floats]: ...
def trains(
    shape: Sequence[int],
    q: _Some,
    gyration_ratio: _Some,
    center_of_mass: _Some,
    e: _Floats,
    velocity: Sequence[_Floats],
    height_gap: _Floats,
    limit: int,
) -> dict[str, _Floats]: ...
def zones(
    shape: Sequence[int], q: _Some, gyration_ratio: _Some, center_of_mass: _Some, e: _Floats, threshold: _Floats
) -> dict[str, _Floats]: ...
def shocks(
    shape: Sequence[int],
    q: _Some,
    gyration_ratio: _Some,
    center_of_mass: _Some,
    e: _Floats,
    velocity: Sequence[_Floats],
    height_gap: _Floats,
    at: _Floats,
    first: str | None,
) -> _Floats: ...
def plates(
    shape: Sequence[int],
    gyration_ratio: Sequence[_Floats],
    center_of_mass: Sequence[_Floats],
    e: _Floats,
    velocity: Sequence[_Floats],
    height_gap: Sequence[_Floats],
    limit: int,
) -> dict[str, _Floats]: ...
def boxes(
    shape: Sequence[int],
    size_m: Sequence[_Floats],
    gyration_m: Sequence[_Floats],
    center_of_mass_m: Sequence[_Floats],
    orientation: Sequence[_Floats],
    spin_rad_s: Sequence[_Floats],
    e: _Floats,
    speed_m_s: _Floats,
    gravity_m_s2: _Floats,
    contact_time_s: _Floats,
    contact_law: str,
) -> dict[str, _Floats]: ...
def simulate(
    inputs: dict[str, Any],
    model_name: str,
    time_limit_s: float | None,
    impact_limit: int | None,
    at: Sequence[tuple[float, float]],
    history: bool,
) -> _Answered: ...
def respond(
    shaken: Sequence[PulseData] | Sequence[tuple[float, float]] | None,
    e: float | None,
    q: float | None,
    gyration_ratio: float | None,
    center_of_mass: float | None,
    masses: Sequence[tuple[float, ...]] | None,
    velocity: _Numbers | None,
    height_gap: float | None,
    at: float | None,
    omega: float,
    damping_ratio: float | None,
    q_factor: float | None,
) -> _Answered: ...
def respond_drop(
    inputs: dict[str, Any],
    model_name: str | None,
    at: Sequence[float],
    axis: str | None,
    frequency_hz: float | None,
    damping_ratio: float | None,
    q_factor: float | None,
    tolerance: float,
) -> _Answered: ...
def spectrum(
    shaken: Sequence[Record] | Sequence[PulseData] | Sequence[tuple[float, float]],
    list_hz: _Numbers | None,
    per_octave_hz: _Numbers | None,
    damping: float | None,
    q_factors: _Numbers | None,
    quantity_name: str,
    interpolation: str,
    limit: float | Sequence[tuple[float, float]] | None,
    required: tuple[float | Sequence[tuple[float, float]] | None, float, float | None] | None,
    enveloping_pulse: str | None,
    find: tuple[float | None, float] | None,
    summaries: Sequence[bool],
) -> _Answered: ...
def spectra(
    histories: _Floats,
    samples: int,
    step_s: float,
    hz: _Numbers,
    damping: float | None,
    q_factor: float | None,
    quantity_name: str,
    interpolation: str,
) -> Sequence[_Floats]: ...
def example() -> str: ...
def schema() -> str: ...
def assess(
    product: ProductText,
    tolerance: float,
    model: str | None,
    merge_s: float,
    folder: str,
    drops: Sequence[tuple[str, _Given, float | None]],
    report: tuple[str, str | None] | None,
) -> tuple[_Answered, list[str]]: ...
def scatter(
    product: ProductText, samples: int | None, seed: int, confidence: float, merge_s: float, target: float | None
) -> _Answered: ...
def design(
    product: ProductText,
    margin: float,
    q: _Pair,
    e: _Pair,
    frequency_factor: float,
    damping: _Pair,
    contact_time_s: _Pair,
    limit_factor: float,
) -> _Answered: ...
def goals(zones: Sequence[tuple[float, float]], turn: float | None) -> _Answered: ...
def explain(product: ProductText, tolerance: float) -> _Answered: ...
def tradeoff(product: ProductText, tolerance: float) -> _Answered: ...
def study(plan: str, shard: Sequence[int], output: str, force: bool) -> tuple[str, str]: ...
def merge(parts: Sequence[str], confidence: float, target: float | None) -> _Answered: ...
def fit(
    product: ProductText,
    given: _Given,
    timing_s: float | None,
    known_gyration: bool,
) -> tuple[str, Drawing | None, str | None, list[str]]: ...
