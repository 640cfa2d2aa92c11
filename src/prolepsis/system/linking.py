"""Machine code that numba has compiled as bytes, and linked into a process again.

numba's own way back parses the code that other kernels may take in, compiles its runtime and imports the modules of
whatever was taken in, several times as long as linking takes. Here each is done once another kernel is compiled.
"""

from __future__ import annotations

import pickle
from functools import lru_cache
from typing import Any, cast

from llvmlite import binding  # pyright: ignore[reportMissingTypeStubs]
from numba.core import environment, serialize  # pyright: ignore[reportMissingTypeStubs]
from numba.core.codegen import CodeLibrary, JITCodeLibrary  # pyright: ignore[reportMissingTypeStubs]
from numba.core.compiler import CompileResult  # pyright: ignore[reportMissingTypeStubs]
from numba.core.runtime import _nrt_python as runtime  # pyright: ignore

llvm: Any = binding


def packed(compiled: Any) -> bytes | None:
    """Return what numba compiled as bytes, or None if it is tied to this process."""
    if compiled.library.has_dynamic_globals or compiled.lifted or compiled.objectmode or compiled.reload_init:
        return None
    _, description, own, signature, *_, others = compiled._reduce()
    code = compiled.library.serialize_using_object_code()
    environments = [(each.globals.get("__name__"), list(each.consts), each.env_name) for each in (own, *others)]
    return cast(Any, serialize).dumps((code, description, signature, environments))


def linked(content: bytes, context: Any) -> Any:
    """Return what was packed, linked for a target; whoever calls has checked whose bytes these are."""
    (name, _, (code, shared)), description, signature, constants = pickle.loads(content)
    _add_runtime()
    library = _Library(context.codegen(), name, code, shared)
    own, *others = [_environment(*each) for each in constants]
    function = context.get_executable(library, description, own)
    for each in others:
        library.codegen.set_env(each.env_name, each)
    make: Any = CompileResult
    known = {
        "target_context": context,
        "typing_context": context.typing_context,
        "library": library,
        "environment": own,
        "entry_point": function,
        "fndesc": description,
        "signature": signature,
        "objectmode": False,
        "lifted": (),
        "reload_init": (),
        "referenced_envs": tuple(others),
    }
    return make(**dict.fromkeys(make._fields) | known)


class _Library(cast(Any, JITCodeLibrary)):
    """Linked machine code; what others may take in of it is parsed when one does."""

    def __init__(self, codegen: Any, name: str, code: bytes, shared: bytes) -> None:
        # Not numba's next one, which makes a module to compile.
        cast(Any, CodeLibrary).__init__(self, codegen, name)
        self._linking_libraries, self._shared_module, self._shared = [], None, shared
        self._disable_inspection = self._finalized = True
        engine = codegen._engine
        engine._ee.add_object_file(llvm.object_file.ObjectFileRef.from_data(code))
        engine.finalize_object()

    def get_pointer_to_function(self, name: str) -> int:
        return self._codegen._engine.get_function_address(name)

    def _get_module_for_linking(self) -> Any:
        if self._shared_module is None:
            self._shared_module = llvm.parse_bitcode(self._shared)
            self._codegen._engine._load_defined_symbols(self._shared_module)
        return self._shared_module


@lru_cache(maxsize=1)
def _add_runtime() -> None:
    """Tell the linker where the functions of numba's runtime are."""
    for name, address in cast(Any, runtime).c_helpers.items():
        llvm.add_symbol(name if name.startswith("_") else f"NRT_{name}", address)


def _environment(module: str | None, constants: list[Any], name: str) -> Any:
    """Return the constants that some code refers to by a name."""
    known = cast(Any, environment).lookup_environment(name)
    if known is None:
        # Only what is not compiled looks up more of its module than the name.
        kind: Any = environment.Environment
        known = kind({"__name__": module})
        known.consts[:] = constants
        known.env_name = name
        kind._memo[name] = known
    return known
