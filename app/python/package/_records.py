"""Events, certificates, phases, points of branches, with the names of `achilles simulate --json` and `orbit --json`."""

from __future__ import annotations

import functools
import json
from typing import Any

import numpy as np

_states = ("q", "v", "v_before", "v_after")


class Record(dict[str, Any]):
    """A dict whose entries are also attributes: event["t"] is event.t. States are NumPy arrays; None marks what does not apply."""

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"{type(self).__name__} has no '{name}'; it has {', '.join(self)}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(name for name in self if name.isidentifier())]

    def __eq__(self, other: object) -> bool:
        """Whether all entries are the same, states number by number."""
        if not isinstance(other, dict) or self.keys() != other.keys():
            return NotImplemented if not isinstance(other, dict) else False
        return all(_same(value, other[name]) for name, value in self.items())

    __hash__ = None  # type: ignore[assignment]

    def __ne__(self, other: object) -> bool:
        same = self.__eq__(other)
        return same if same is NotImplemented else not same


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return bool(np.array_equal(one, other))
    return bool(one == other)


class Certificate(Record):
    """The certificate of a truncated impact sequence; `achilles help data` explains each bound."""

    certified: bool
    conditions: str
    reinitialization: str
    below_rounding: bool
    zeno_time: list[float]
    position_bound: float | None
    velocity_bound: float | None
    shadowing_position: float | None
    shadowing_velocity: float | None
    uniform_position: float | None
    a_min: float | None
    a_max: float | None
    decisive: str
    tail: str
    inequalities: list[Record]
    e1: float
    e2: float
    beta: float
    eta: float
    zeta: float
    c1: float
    c2: float
    c3: float
    transmission: Record
    least_force: Record
    least_other_gap: float | None
    rounded_zero: bool
    given: str


class Event(Record):
    """An impact, a Zeno point, a release or a collapse; with friction, a stick, a slip or a reversal; a jump, or a pass.

    An impact has v_before and v_after, the others have v. A Zeno point has a certificate, the start of a slip and a
    reversal a direction (1 or -1, or one for each contact by name where they differ), and an impact with friction has
    tangential_impulses. A Zeno point at which friction stops every slip has sticks_from, the number of the first such
    impact, and its certificate a tail: "slip", "stick" or "stick then slip". A collapse has the impulses and the loss
    of the plastic impact that its impacts converge to, the factors speed_ratio and gap_ratio per two impacts, and a
    certificate.

    A jump has its name, q_before and v_before, q and v_after, its loss of energy, and gains_energy where that is negative.
    A pass is the closing of a gap that does not count. Where contacts may not count, inactive names those that do not
    count after the event. Where contacts have a latch, latched names those that it holds after the event; a release with
    ends_latch is due to the end of a latch, not to a force that vanishes."""

    kind: str
    t: float
    error_estimate: float | None
    q: np.ndarray
    v: np.ndarray
    v_before: np.ndarray
    v_after: np.ndarray
    impact_speed: float
    impulses: Record
    contact: str
    contacts: list[str]
    held: list[str]
    opened: list[str]
    impacts: int
    truncation: Record
    certificate: Certificate
    order_matters: bool
    not_unique: bool
    rounded_zero: bool
    alternatives: list[Record]
    direction: int | Record
    sticks_from: int
    modes: Record
    tangential_impulses: Record
    energy_capped: Record
    loss: float
    speed_ratio: float
    gap_ratio: float
    inactive: list[str]
    latched: list[str]
    ends_latch: bool
    name: str
    q_before: np.ndarray
    gains_energy: bool


class Phase(Record):
    """A part of a run, from start to end: hybrid (flights and impacts) or constrained, while contacts are held."""

    kind: str
    held: list[str]
    start: float
    end: float
    impacts: int
    not_unique: bool
    modes: Record


class OrbitPoint(Record):
    """A periodic run at one value of the branch's parameter; multipliers is an array of complex numbers."""

    value: float
    period: float
    state: Record
    multipliers: np.ndarray
    zero_multipliers: int
    shift: dict[str, float]
    stable: bool
    margins: Record
    psi: float | None


def _record(pairs: list[tuple[str, Any]]) -> Record:
    record: Record = Record()
    for name, value in pairs:
        if name in _states and isinstance(value, list) and not (value and isinstance(value[0], Record)):
            value = np.array(value, dtype=float)
        elif name == "certificate" and isinstance(value, Record):
            value = Certificate(value)
        elif name in ("events", "phases"):
            value = [(Event if name == "events" else Phase)(each) for each in value]
        elif name == "multipliers" and isinstance(value, list):
            value = np.array([complex(*each) for each in value])
        dict.__setitem__(record, name, value)
    return record


def records(text: str) -> Record:
    """Parses JSON output of achilles into records."""
    return json.loads(text, object_pairs_hook=_record)


def derivative_records(value: Any) -> Any:
    """Converts parsed JSON: nested lists of numbers to arrays, objects to records."""
    if isinstance(value, dict):
        return Record({name: derivative_records(each) for name, each in value.items()})
    if not isinstance(value, list) or any(isinstance(each, (dict, str)) for each in value):
        return [derivative_records(each) for each in value] if isinstance(value, list) else value
    return np.array(value, dtype=float)


class _Result:
    """Base class of Run and Orbit. Their JSON is parsed on first use."""

    @functools.cached_property
    def _record(self) -> Record:
        return records(self.to_json())


def entry(name: str, doc: str) -> Any:
    """Makes a property that returns this entry of the result's JSON."""
    return property(lambda result: result._record[name], doc=doc)
