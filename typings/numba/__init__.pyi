# What this code uses of numba, for the type checker: a compiled function keeps the type of the plain one.
from collections.abc import Callable
from typing import Any, TypeVar, overload

_F = TypeVar("_F", bound=Callable[..., Any])

@overload
def njit(function: _F) -> _F: ...
@overload
def njit(**options: Any) -> Callable[[_F], _F]: ...

prange = range

class _Config:
    DISABLE_JIT: bool
    CACHE_DIR: str

config: _Config
