"""Functions of lanes, and of scalars as they are of a lane; only compiled code may call them.

An array is read and written by the number of its first element in memory, whatever its shape: no sign of an index is
looked at, and no bound.
"""

# mypy: disallow-untyped-calls=False

from __future__ import annotations

import math
from collections.abc import Callable
from inspect import Parameter, Signature
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing.templates import signature
from numba.extending import intrinsic

from siggen.arrays import FloatArray
from siggen.lanes.kinds import (
    DOUBLE,
    DOUBLES,
    INT32,
    INT64,
    LANES,
    SCALARS,
    Doubles,
    LanesType,
    Wholes,
    as_lanes,
    joined_kind,
)


class _Call(NamedTuple):
    """A call to be lowered: numba's context, the builder of LLVM, the signature, the values of the arguments."""

    context: Any
    builder: Any
    signature: Any
    args: tuple[Any, ...]

    def address(self, index: Any) -> Any:
        """Return where an element of the array that came first lies, by its number in memory."""
        array = self.context.make_array(self.signature.args[0])(self.context, self.builder, self.args[0])
        return self.builder.gep(array.data, [index], inbounds=True)

    def vectors(self, first: int, kind: Any) -> list[Any]:
        """Return the vectors of the arguments from one on, spread where they are scalars."""
        given = zip(self.args[first:], self.signature.args[first:], strict=True)
        return [as_lanes(self.context, self.builder, value, of, kind) for value, of in given]


def _lowered(names: str, kinds: Callable[..., Any]) -> Callable[[Callable[[_Call], Any]], Any]:
    """Return the decorator that makes a function for compiled code of one that emits LLVM's code for a call.

    `names` are those of the arguments; `kinds` returns the signature for their types.
    """
    parameters = [Parameter(name, Parameter.POSITIONAL_OR_KEYWORD) for name in ("typing", *names.split())]

    def decorated(emit: Callable[[_Call], Any]) -> Any:
        def definition(_: Any, *given: Any) -> Any:
            if any(isinstance(one, types.Array) and (one.dtype, one.layout) != (types.float64, "C") for one in given):
                return None  # numba names function and types
            return kinds(*given), lower

        def lower(*call: Any) -> Any:
            return emit(_Call(*call))

        definition.__name__, definition.__doc__ = emit.__name__, emit.__doc__
        vars(definition)["__signature__"] = Signature(parameters)
        return intrinsic(definition)

    return decorated


def splat_of(lanes: int) -> Any:
    """Return the function that puts a float in so many lanes; more than LANES are several registers in one value."""
    kind = Doubles(lanes)

    @_lowered("value", kind)
    def spread(call: _Call) -> Any:
        (vector,) = call.vectors(0, kind)
        return vector

    return spread


splat = splat_of(LANES)


def _read(call: _Call) -> Any:
    """Return elements of an array from one on, as many as the result has lanes."""
    kind = call.signature.return_type
    vector = kind.vector if isinstance(kind, LanesType) else DOUBLE
    place = call.builder.bitcast(call.address(call.args[1]), vector.as_pointer())
    return call.builder.load(place, align=8)


load = _lowered("array first", lambda array, _: DOUBLES(array, types.intp))(_read)
"""Return eight elements of an array of doubles from one on."""
load_like = _lowered("array first like", lambda array, _, like: like(array, types.intp, like))(_read)
"""Return as many as another value has lanes."""


@_lowered("array first value", lambda array, _, value: types.void(array, types.intp, value))
def store(call: _Call) -> Any:
    """Write lanes into an array of doubles from one element on."""
    value = call.args[2]
    call.builder.store(value, call.builder.bitcast(call.address(call.args[1]), value.type.as_pointer()), align=8)
    return call.context.get_dummy_value()


@_lowered("array number", lambda array, _: types.float64(array, types.intp))
def scalar_at(call: _Call) -> Any:
    """Return one element of an array of doubles by its number in memory."""
    return call.builder.load(call.address(call.args[1]), align=8)


def _found_at(places: Any) -> Any:
    """Return of which kind doubles are that stand at places."""
    return DOUBLES if isinstance(places, LanesType) else types.float64


@_lowered("array places", lambda array, places: _found_at(places)(array, places))
def gather(call: _Call) -> Any:
    """Return the elements of an array of doubles at eight places."""
    if not isinstance(call.signature.args[1], LanesType):
        return call.builder.load(call.address(call.args[1]), align=8)
    result = ir.Constant(DOUBLES.vector, ir.Undefined)
    for lane in range(LANES):
        index = call.builder.extract_element(call.args[1], ir.Constant(INT32, lane))
        result = call.builder.insert_element(
            result, call.builder.load(call.address(index), align=8), ir.Constant(INT32, lane)
        )
    return result


@_lowered("array places", lambda array, places: types.UniTuple(_found_at(places), 2)(array, places))
def gather_pairs(call: _Call) -> Any:
    """Return the elements of an array of doubles at eight places, and those behind them."""
    builder, parts = call.builder, []
    if not isinstance(call.signature.args[1], LanesType):
        here = call.address(call.args[1])
        both = builder.load(here, align=8), builder.load(builder.gep(here, [INT64(1)], inbounds=True), align=8)
        return call.context.make_tuple(builder, call.signature.return_type, both)
    for lane in range(LANES):
        index = builder.extract_element(call.args[1], ir.Constant(INT32, lane))
        place = builder.bitcast(call.address(index), ir.VectorType(DOUBLE, 2).as_pointer())
        parts.append(builder.load(place, align=8))
    even, odd = (_joined(builder, parts[first::2]) for first in (0, 1))
    low = _shuffled(builder, even, odd, [0, 8, 2, 10, 4, 12, 6, 14])
    high = _shuffled(builder, even, odd, [1, 9, 3, 11, 5, 13, 7, 15])
    return call.context.make_tuple(builder, call.signature.return_type, (low, high))


def _shuffled(builder: Any, left: Any, right: Any, lanes: list[int]) -> Any:
    return builder.shuffle_vector(left, right, ir.Constant(ir.VectorType(INT32, len(lanes)), lanes))


def _joined(builder: Any, parts: list[Any]) -> Any:
    """Return short vectors of one length, a power of two of them, as a long one."""
    while len(parts) > 1:
        lanes = list(range(2 * parts[0].type.count))
        parts = [_shuffled(builder, a, b, lanes) for a, b in zip(parts[::2], parts[1::2], strict=True)]
    return parts[0]


def shuffle(*lanes: int) -> Any:
    """Return the function that takes each of eight lanes from the lane of this number."""
    assert len(lanes) == LANES

    @_lowered("value", DOUBLES)
    def shuffled(call: _Call) -> Any:
        return _shuffled(call.builder, call.args[0], call.args[0], list(lanes))

    return shuffled


@_lowered(
    "value lane", lambda value, _: (types.float64 if isinstance(value, Doubles) else types.int64)(value, types.int32)
)
def extract(call: _Call) -> Any:
    """Return one lane as a float or an integer."""
    return call.builder.extract_element(*call.args)


@_lowered("value lane scalar", lambda value, *_: value(value, types.int32, types.float64))
def insert(call: _Call) -> Any:
    """Return lanes with a float put into one of them."""
    value, lane, scalar = call.args
    return call.builder.insert_element(value, scalar, lane)


def _selected(chosen: Any, *sides: Any) -> Any:
    kind = joined_kind(sides)
    return (Doubles(chosen.lanes) if isinstance(chosen, LanesType) and kind in SCALARS else kind)(chosen, *sides)


@_lowered("chosen left right", _selected)
def select(call: _Call) -> Any:
    """Return the left lanes where chosen, else the right ones."""
    return call.builder.select(call.args[0], *call.vectors(1, call.signature.return_type))


def _extreme(sign: str) -> Any:
    """Return the smaller or larger of two as `min` and `max` of numba are: the first where they do not compare."""

    @_lowered("left right", lambda *given: joined_kind(given)(*given))
    def extreme(call: _Call) -> Any:
        kind = call.signature.return_type
        a, b = call.vectors(0, kind)
        real = kind == types.float64 or isinstance(kind, Doubles)
        compared = call.builder.fcmp_ordered if real else call.builder.icmp_signed
        return call.builder.select(compared(sign, b, a), b, a)

    return extreme


smaller, larger = _extreme("<"), _extreme(">")


def _function(name: str) -> Any:
    """Return a function of doubles that LLVM knows for vectors and rounds correctly."""

    @_lowered("value", lambda value: value(value))
    def of_lanes(call: _Call) -> Any:
        vector = call.args[0].type
        function = ir.FunctionType(vector, [vector])
        insert_function: Any = cgutils.get_or_insert_function
        kind = f"v{vector.count}f64" if isinstance(vector, ir.VectorType) else "f64"
        return call.builder.call(insert_function(call.builder.module, function, f"llvm.{name}.{kind}"), call.args)

    return of_lanes


square_root, magnitude = _function("sqrt"), _function("fabs")


def _as_bits(builder: Any, chosen: Any) -> Any:
    return builder.zext(builder.bitcast(chosen, ir.IntType(chosen.type.count)), INT64)


def _lane_of(builder: Any, vector: Any, lane: Any) -> Any:
    """Return where a lane of a vector in memory lies."""
    return builder.gep(builder.bitcast(vector, DOUBLE.as_pointer()), [lane], inbounds=True)


def _called(function: Any) -> Any:
    """Return a function of doubles that is called for every lane by itself, and only where chosen; 0 elsewhere."""

    @_lowered("value chosen", lambda value, chosen: value(value, chosen))
    def where_chosen(call: _Call) -> Any:
        builder, (value, chosen) = call.builder, call.args
        of_scalar = call.context.get_function(function, signature(types.float64, types.float64))
        if not isinstance(value.type, ir.VectorType):
            found = cgutils.alloca_once_value(builder, DOUBLE(0.0))
            with builder.if_then(chosen):
                builder.store(of_scalar(builder, (value,)), found)
            return builder.load(found)
        # In memory, lane after lane: vectors would be put aside around every call.
        given = cgutils.alloca_once_value(builder, value)
        found = cgutils.alloca_once_value(builder, ir.Constant(value.type, None))
        left = cgutils.alloca_once_value(builder, _as_bits(builder, chosen))
        again, body, behind = (builder.append_basic_block(name) for name in ("again", "lane", "behind"))
        builder.branch(again)
        builder.position_at_end(again)
        mask = builder.load(left)
        builder.cbranch(builder.icmp_unsigned("!=", mask, INT64(0)), body, behind)
        builder.position_at_end(body)
        lane = builder.cttz(mask, ir.IntType(1)(1))
        one = builder.load(_lane_of(builder, given, lane))
        builder.store(of_scalar(builder, (one,)), _lane_of(builder, found, lane))
        builder.store(builder.and_(mask, builder.sub(mask, INT64(1))), left)
        builder.branch(again)
        builder.position_at_end(behind)
        return builder.load(found)

    return where_chosen


logarithm, hyperbolic_tangent = _called(math.log), _called(math.tanh)


@_lowered("value", lambda value: (Wholes(value.lanes) if isinstance(value, LanesType) else types.int64)(value))
def truncated(call: _Call) -> Any:
    """Return the integers that `int` makes of doubles."""
    return call.builder.fptosi(call.args[0], getattr(call.signature.return_type, "vector", INT64))


@_lowered("value", lambda value: (Doubles(value.lanes) if isinstance(value, LanesType) else types.float64)(value))
def as_doubles(call: _Call) -> Any:
    """Return integers as doubles."""
    return call.builder.sitofp(call.args[0], getattr(call.signature.return_type, "vector", DOUBLE))


@_lowered("chosen", types.boolean)
def any_of(call: _Call) -> Any:
    """Return whether one lane is chosen, or the scalar."""
    builder, chosen = call.builder, call.args[0]
    if not isinstance(chosen.type, ir.VectorType):
        return chosen
    return builder.icmp_unsigned("!=", _as_bits(builder, chosen), INT64(0))


@_lowered("chosen", types.int64)
def bits(call: _Call) -> Any:
    """Return truths as an integer, the first lane in the lowest place."""
    return _as_bits(call.builder, call.args[0])


def aligned(values: FloatArray) -> FloatArray:
    """Return a copy that begins at a whole register: no read of its rows, if they fill registers, takes two lines."""
    raw = np.empty(values.size + LANES)
    first = -(raw.ctypes.data // raw.itemsize) % LANES
    result = raw[first : first + values.size].reshape(values.shape)
    result[...] = values
    return result
