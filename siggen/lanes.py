"""Lanes: eight doubles in one vector register, for compiled loops whose vectorising no compiler finds by itself.

Every operation is that of IEEE 754 on each lane by itself, in the order written: lanes have the bytes of the scalars
that they stand for. Machines with registers of four or two doubles take several for one value; bytes stay the same.
numba knows no such type; it is told here how to lower it. Only compiled code may call these functions.

An array is read and written by the number of its first element in memory, whatever its shape: no sign of an index is
looked at, and no bound.
"""

# mypy: disallow-untyped-calls=False

from __future__ import annotations

import operator
from collections.abc import Callable
from inspect import Parameter, Signature
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model

from siggen.arrays import FloatArray

LANES = 8
_DOUBLE, _INT64, _INT32 = ir.DoubleType(), ir.IntType(64), ir.IntType(32)
Lanes = Any
Whole = Any
Choice = Any
"""Eight doubles, integers and truths; checkers see nothing of them: no such object exists outside compiled code."""


class _LanesType(types.Type):
    """So many lanes of one kind."""

    def __init__(self, scalar: Any, lanes: int) -> None:
        self.lanes, self.scalar = lanes, scalar
        held = {types.float64: _DOUBLE, types.int64: _INT64, types.boolean: ir.IntType(1)}[scalar]
        self.vector = ir.VectorType(held, lanes)
        super().__init__(name=f"lanes({scalar}, {lanes})")


class _Doubles(_LanesType):
    def __init__(self, lanes: int) -> None:
        super().__init__(types.float64, lanes)


class _Wholes(_LanesType):
    def __init__(self, lanes: int) -> None:
        super().__init__(types.int64, lanes)


class _Truths(_LanesType):
    def __init__(self, lanes: int) -> None:
        super().__init__(types.boolean, lanes)


@register_model(_Doubles)
@register_model(_Wholes)
@register_model(_Truths)
class _Model(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, kind.vector)


DOUBLES, WHOLES, TRUTHS = _Doubles(LANES), _Wholes(LANES), _Truths(LANES)


def _spread(builder: Any, value: Any, vector: Any) -> Any:
    """Return a vector with the scalar in all lanes."""
    first = builder.insert_element(ir.Constant(vector, ir.Undefined), value, ir.Constant(_INT32, 0))
    zeros = ir.Constant(ir.VectorType(_INT32, vector.count), [0] * vector.count)
    return builder.shuffle_vector(first, ir.Constant(vector, ir.Undefined), zeros)


def _as_lanes(context: Any, builder: Any, value: Any, given: Any, wanted: Any) -> Any:
    """Return the vector of a value, in all lanes where it is a scalar."""
    if isinstance(given, _LanesType):
        return value
    return _spread(builder, context.cast(builder, value, given, wanted.scalar), wanted.vector)


def _kind(args: tuple[Any, ...]) -> Any:
    """Return of which kind lanes are that are to be joined with each other or with scalars; None where none are."""
    kinds = {arg for arg in args if isinstance(arg, _LanesType)}
    scalars = [arg for arg in args if not isinstance(arg, _LanesType)]
    if len(kinds) != 1 or not all(isinstance(arg, (types.Number, types.Boolean)) for arg in scalars):
        return None
    (kind,) = kinds
    return None if isinstance(kind, _Wholes) and any(isinstance(arg, types.Float) for arg in scalars) else kind


def _operation(symbol: Any, result: Callable[[Any], Any], emit: dict[Any, Callable[[Any, Any, Any], Any]]) -> None:
    """Let numba lower an operator on lanes: `emit` by kind takes builder and both vectors."""

    @infer_global(symbol)
    class _Template(AbstractTemplate):
        def generic(self, args: tuple[Any, ...], _: Any) -> Any:
            kind = _kind(args) if len(args) == 2 else None
            return signature(result(kind), *args) if type(kind) in emit else None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        kind = _kind(sig.args)
        left, right = (_as_lanes(context, builder, a, t, kind) for a, t in zip(args, sig.args, strict=True))
        return emit[type(kind)](builder, left, right)

    for pattern in ((_LanesType, _LanesType), (_LanesType, types.Number), (types.Number, _LanesType)):
        lower_builtin(symbol, *pattern)(lower)


def _register_operators() -> None:
    def emitted(method: str, *sign: str) -> Callable[[Any, Any, Any], Any]:
        return lambda builder, left, right: getattr(builder, method)(*sign, left, right)

    for symbol, real, whole in (
        (operator.add, "fadd", "add"), (operator.sub, "fsub", "sub"), (operator.mul, "fmul", "mul"),
    ):  # fmt: skip
        _operation(symbol, lambda kind: kind, {_Doubles: emitted(real), _Wholes: emitted(whole)})
    _operation(operator.truediv, lambda kind: kind, {_Doubles: emitted("fdiv")})
    for symbol, sign in (
        (operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">="), (operator.eq, "=="),
        (operator.ne, "!="),
    ):  # fmt: skip
        # As Python compares: false beside what is no number, but for unequal, which is true.
        real = "fcmp_unordered" if sign == "!=" else "fcmp_ordered"
        emit = {_Doubles: emitted(real, sign), _Wholes: emitted("icmp_signed", sign)}
        _operation(symbol, lambda kind: _Truths(kind.lanes), emit)
    for symbol, method in ((operator.and_, "and_"), (operator.or_, "or_")):
        _operation(symbol, lambda kind: kind, {_Truths: emitted(method)})


_register_operators()


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
        return [_as_lanes(self.context, self.builder, value, of, kind) for value, of in given]


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
    kind = _Doubles(lanes)

    @_lowered("value", kind)
    def spread(call: _Call) -> Any:
        (vector,) = call.vectors(0, kind)
        return vector

    return spread


splat = splat_of(LANES)


def _read(call: _Call) -> Any:
    """Return elements of an array from one on, as many as the result has lanes."""
    place = call.builder.bitcast(call.address(call.args[1]), call.signature.return_type.vector.as_pointer())
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


@_lowered("array places", DOUBLES)
def gather(call: _Call) -> Any:
    """Return the elements of an array of doubles at eight places."""
    result = ir.Constant(DOUBLES.vector, ir.Undefined)
    for lane in range(LANES):
        index = call.builder.extract_element(call.args[1], ir.Constant(_INT32, lane))
        result = call.builder.insert_element(
            result, call.builder.load(call.address(index), align=8), ir.Constant(_INT32, lane)
        )
    return result


@_lowered("array places", types.UniTuple(DOUBLES, 2))
def gather_pairs(call: _Call) -> Any:
    """Return the elements of an array of doubles at eight places, and those behind them."""
    builder, parts = call.builder, []
    for lane in range(LANES):
        index = builder.extract_element(call.args[1], ir.Constant(_INT32, lane))
        place = builder.bitcast(call.address(index), ir.VectorType(_DOUBLE, 2).as_pointer())
        parts.append(builder.load(place, align=8))
    even, odd = (_joined(builder, parts[first::2]) for first in (0, 1))
    low = _shuffled(builder, even, odd, [0, 8, 2, 10, 4, 12, 6, 14])
    high = _shuffled(builder, even, odd, [1, 9, 3, 11, 5, 13, 7, 15])
    return call.context.make_tuple(builder, call.signature.return_type, (low, high))


def _shuffled(builder: Any, left: Any, right: Any, lanes: list[int]) -> Any:
    return builder.shuffle_vector(left, right, ir.Constant(ir.VectorType(_INT32, len(lanes)), lanes))


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
    "value lane", lambda value, _: (types.float64 if isinstance(value, _Doubles) else types.int64)(value, types.int32)
)
def extract(call: _Call) -> Any:
    """Return one lane as a float or an integer."""
    return call.builder.extract_element(*call.args)


@_lowered("value lane scalar", lambda value, *_: value(value, types.int32, types.float64))
def insert(call: _Call) -> Any:
    """Return lanes with a float put into one of them."""
    value, lane, scalar = call.args
    return call.builder.insert_element(value, scalar, lane)


@_lowered("chosen left right", lambda chosen, *sides: (_kind(sides) or DOUBLES)(chosen, *sides))
def select(call: _Call) -> Any:
    """Return the left lanes where chosen, else the right ones."""
    return call.builder.select(call.args[0], *call.vectors(1, call.signature.return_type))


def _extreme(sign: str) -> Any:
    """Return the smaller or larger of two as `min` and `max` of numba are: the first where they do not compare."""

    @_lowered("left right", lambda *given: _kind(given)(*given))
    def extreme(call: _Call) -> Any:
        kind = call.signature.return_type
        a, b = call.vectors(0, kind)
        compared = call.builder.fcmp_ordered if isinstance(kind, _Doubles) else call.builder.icmp_signed
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
        return call.builder.call(
            insert_function(call.builder.module, function, f"llvm.{name}.v{vector.count}f64"), call.args
        )

    return of_lanes


square_root, magnitude = _function("sqrt"), _function("fabs")


@_lowered("value", lambda value: _Wholes(value.lanes)(value))
def truncated(call: _Call) -> Any:
    """Return the integers that `int` makes of doubles."""
    return call.builder.fptosi(call.args[0], call.signature.return_type.vector)


@_lowered("value", lambda value: _Doubles(value.lanes)(value))
def as_doubles(call: _Call) -> Any:
    """Return integers as doubles."""
    return call.builder.sitofp(call.args[0], call.signature.return_type.vector)


@_lowered("chosen", types.int64)
def bits(call: _Call) -> Any:
    """Return truths as an integer, the first lane in the lowest place."""
    chosen = call.args[0]
    return call.builder.zext(call.builder.bitcast(chosen, ir.IntType(chosen.type.count)), _INT64)


def aligned(values: FloatArray) -> FloatArray:
    """Return a copy that begins at a whole register: no read of its rows, if they fill registers, takes two lines."""
    raw = np.empty(values.size + LANES)
    first = -(raw.ctypes.data // raw.itemsize) % LANES
    result = raw[first : first + values.size].reshape(values.shape)
    result[...] = values
    return result
