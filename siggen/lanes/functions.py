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
from numba.extending import intrinsic

from siggen.arrays import FloatArray
from siggen.compiled import njit
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
    spread,
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


def _between_kinds(array: Any, low: Any, high: Any, share: Any) -> Any:
    return types.UniTuple(share, LANES)(array, low, high, share)


@_lowered("array low high share", _between_kinds)
def gather_between(call: _Call) -> Any:
    """Return eight values, each linear between that behind one place of an array and that behind another one."""
    builder = call.builder

    def row(low: Any, high: Any, share: Any) -> Any:
        a, b = (
            builder.load(builder.bitcast(call.address(at), DOUBLES.vector.as_pointer()), align=8) for at in (low, high)
        )
        return builder.fadd(a, builder.fmul(spread(builder, share, DOUBLES.vector), builder.fsub(b, a)))

    if not isinstance(call.signature.args[1], LanesType):
        values = row(*call.args[1:])
        parts = [builder.extract_element(values, INT32(lane)) for lane in range(LANES)]
    else:
        parts = _transposed(
            builder, [row(*(builder.extract_element(a, INT32(lane)) for a in call.args[1:])) for lane in range(LANES)]
        )
    return call.context.make_tuple(builder, call.signature.return_type, parts)


def _transposed(builder: Any, rows: list[Any]) -> list[Any]:
    """Return the columns of eight rows of eight."""
    lows, highs = [0, 8, 2, 10, 4, 12, 6, 14], [1, 9, 3, 11, 5, 13, 7, 15]
    first, second = [0, 1, 4, 5, 8, 9, 12, 13], [2, 3, 6, 7, 10, 11, 14, 15]  # every other pair of lanes
    columns: list[Any] = [None] * LANES
    for odd, lanes in enumerate((lows, highs)):
        twos = [_shuffled(builder, rows[r], rows[r + 1], lanes) for r in range(0, LANES, 2)]
        for behind, chosen in enumerate((first, second)):
            fours = [_shuffled(builder, twos[t], twos[t + 1], chosen) for t in (0, 2)]
            for far, last in enumerate((first, second)):
                columns[4 * far + 2 * behind + odd] = _shuffled(builder, fours[0], fours[1], last)
    return columns


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


def _whole_like(value: Any) -> Any:
    """Return the type of integers for a double or lanes of them."""
    return ir.VectorType(INT64, value.type.count) if isinstance(value.type, ir.VectorType) else INT64


def _everywhere(kind: Any, number: int) -> Any:
    return kind([number] * kind.count) if isinstance(kind, ir.VectorType) else kind(number)


@_lowered("value", lambda value: types.UniTuple(value, 2)(value))
def mantissa_and_exponent(call: _Call) -> Any:
    """Return m in [1, 2) and a whole e of m 2^e for normal positive doubles."""
    builder, (value,) = call.builder, call.args
    kind = _whole_like(value)
    whole = builder.bitcast(value, kind)
    exponent = builder.sub(builder.lshr(whole, _everywhere(kind, 52)), _everywhere(kind, 1023))
    mantissa = builder.or_(builder.and_(whole, _everywhere(kind, (1 << 52) - 1)), _everywhere(kind, 1023 << 52))
    both = builder.bitcast(mantissa, value.type), builder.sitofp(exponent, value.type)
    return call.context.make_tuple(builder, call.signature.return_type, both)


@_lowered("exponent", lambda exponent: exponent(exponent))
def power_of_two(call: _Call) -> Any:
    """Return 2^e of doubles that are whole, from -1022 to 1023."""
    builder, (value,) = call.builder, call.args
    kind = _whole_like(value)
    biased = builder.add(builder.fptosi(value, kind), _everywhere(kind, 1023))
    return builder.bitcast(builder.shl(biased, _everywhere(kind, 52)), value.type)


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


# Logarithm and hyperbolic tangent of lanes at once, with the same bytes on every machine, which those of a system's
# library have not: the first within two units of the last place, the second within 4e-16. Methods and coefficients:
# fdlibm (Sun Microsystems 1993), `e_log.c` and `e_exp.c`.

SQRT_2, LOG2_E = math.sqrt(2.0), math.log2(math.e)
STRAIGHT = 20.0
"""tanh is 1 beyond."""
LOG_2_HIGH, LOG_2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
"""Their sum is ln 2; the first has zeros behind, so that its product with an exponent is exact."""


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def logarithm(value: Any) -> Any:
    """Return the natural logarithm of normal positive doubles."""
    mantissa, exponent = mantissa_and_exponent(value)
    upper = mantissa > SQRT_2
    f = select(upper, 0.5 * mantissa, mantissa) - 1.0
    exponent = select(upper, exponent + 1.0, exponent)
    s = f / (2.0 + f)
    z = s * s
    w = z * z
    odd = z * (6.666666666666735130e-01 + w * (2.857142874366239149e-01 + w * (
        1.818357216161805012e-01 + w * 1.479819860511658591e-01)))  # fmt: skip
    even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01))
    half = 0.5 * f * f
    return exponent * LOG_2_HIGH - ((half - (s * (half + (odd + even)) + exponent * LOG_2_LOW)) - f)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _exponential(value: Any) -> Any:
    """Return e^x for x from 0 to 700."""
    exponent = as_doubles(truncated(value * LOG2_E + 0.5))
    high, low = value - exponent * LOG_2_HIGH, exponent * LOG_2_LOW
    x = high - low
    t = x * x
    c = x - t * (1.66666666666666019037e-01 + t * (-2.77777777770155933842e-03 + t * (
        6.61375632143793436117e-05 + t * (-1.65339022054652515390e-06 + t * 4.13813679705723846039e-08))))  # fmt: skip
    return (1.0 - ((low - x * c / (2.0 - c)) - high)) * power_of_two(exponent)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def hyperbolic_tangent(value: Any) -> Any:
    """Return tanh, within 4e-16 of its true value."""
    sign, size = select(value < 0.0, -1.0, 1.0), smaller(magnitude(value), STRAIGHT)
    if any_of(size < STRAIGHT):
        return sign * (1.0 - 2.0 / (_exponential(2.0 * size) + 1.0))
    return sign


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
