"""Eight doubles, integers or truths in one value: kinds that numba does not know, and their operators."""

# mypy: disallow-untyped-calls=False

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba.core import types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin, models, register_model

LANES = 8
SCALARS = (types.float64, types.int64)
DOUBLE, INT64, INT32 = ir.DoubleType(), ir.IntType(64), ir.IntType(32)


class LanesType(types.Type):
    """So many lanes of one kind."""

    def __init__(self, scalar: Any, lanes: int) -> None:
        self.lanes, self.scalar = lanes, scalar
        held = {types.float64: DOUBLE, types.int64: INT64, types.boolean: ir.IntType(1)}[scalar]
        self.vector = ir.VectorType(held, lanes)
        super().__init__(name=f"lanes({scalar}, {lanes})")


class Doubles(LanesType):
    """Floats."""

    def __init__(self, lanes: int) -> None:
        super().__init__(types.float64, lanes)


class Wholes(LanesType):
    """Integers."""

    def __init__(self, lanes: int) -> None:
        super().__init__(types.int64, lanes)


class Truths(LanesType):
    """Truths."""

    def __init__(self, lanes: int) -> None:
        super().__init__(types.boolean, lanes)


@register_model(Doubles)
@register_model(Wholes)
@register_model(Truths)
class _Model(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, kind.vector)


DOUBLES, WHOLES, TRUTHS = Doubles(LANES), Wholes(LANES), Truths(LANES)


def spread(builder: Any, value: Any, vector: Any) -> Any:
    """Return a vector with the scalar in all lanes."""
    first = builder.insert_element(ir.Constant(vector, ir.Undefined), value, ir.Constant(INT32, 0))
    zeros = ir.Constant(ir.VectorType(INT32, vector.count), [0] * vector.count)
    return builder.shuffle_vector(first, ir.Constant(vector, ir.Undefined), zeros)


def as_lanes(context: Any, builder: Any, value: Any, given: Any, wanted: Any) -> Any:
    """Return the vector of a value, in all lanes where it is a scalar; a scalar where one is wanted."""
    if isinstance(given, LanesType):
        return value
    if not isinstance(wanted, LanesType):
        return context.cast(builder, value, given, wanted)
    return spread(builder, context.cast(builder, value, given, wanted.scalar), wanted.vector)


def joined_kind(args: tuple[Any, ...]) -> Any:
    """Return of which kind lanes are that are to be joined with each other or with scalars, or what scalars become."""
    kinds = {arg for arg in args if isinstance(arg, LanesType)}
    scalars = [arg for arg in args if not isinstance(arg, LanesType)]
    if len(kinds) > 1 or not all(isinstance(arg, (types.Number, types.Boolean)) for arg in scalars):
        return None
    if not kinds:
        return types.float64 if any(isinstance(arg, types.Float) for arg in scalars) else types.int64
    (kind,) = kinds
    return None if isinstance(kind, Wholes) and any(isinstance(arg, types.Float) for arg in scalars) else kind


def _operation(symbol: Any, result: Callable[[Any], Any], emit: dict[Any, Callable[[Any, Any, Any], Any]]) -> None:
    """Let numba lower an operator on lanes: `emit` by kind takes builder and both vectors."""

    @infer_global(symbol)
    class _Template(AbstractTemplate):
        def generic(self, args: tuple[Any, ...], _: Any) -> Any:
            kind = joined_kind(args) if len(args) == 2 else None
            return signature(result(kind), *args) if type(kind) in emit else None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        kind = joined_kind(sig.args)
        left, right = (as_lanes(context, builder, a, t, kind) for a, t in zip(args, sig.args, strict=True))
        return emit[type(kind)](builder, left, right)

    for pattern in ((LanesType, LanesType), (LanesType, types.Number), (types.Number, LanesType)):
        lower_builtin(symbol, *pattern)(lower)


def _register_operators() -> None:
    def emitted(method: str, *sign: str) -> Callable[[Any, Any, Any], Any]:
        return lambda builder, left, right: getattr(builder, method)(*sign, left, right)

    for symbol, real, whole in (
        (operator.add, "fadd", "add"), (operator.sub, "fsub", "sub"), (operator.mul, "fmul", "mul"),
    ):  # fmt: skip
        _operation(symbol, lambda kind: kind, {Doubles: emitted(real), Wholes: emitted(whole)})
    _operation(operator.truediv, lambda kind: kind, {Doubles: emitted("fdiv")})
    for symbol, sign in (
        (operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">="), (operator.eq, "=="),
        (operator.ne, "!="),
    ):  # fmt: skip
        # As Python compares: false beside what is no number, but for unequal, which is true.
        real = "fcmp_unordered" if sign == "!=" else "fcmp_ordered"
        emit = {Doubles: emitted(real, sign), Wholes: emitted("icmp_signed", sign)}
        _operation(symbol, lambda kind: Truths(kind.lanes), emit)
    for symbol, method in ((operator.and_, "and_"), (operator.or_, "or_")):
        _operation(symbol, lambda kind: kind, {Truths: emitted(method)})


_register_operators()
