"""Files are written in one way, `siggen.file_writing`: what fills one is given a draft, never the final name."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from tests.house.source_tree import ROOT, tree
from tests.house.test_house import CODE, offenders

ON_A_PATH = {"write_text", "write_bytes", "touch", "hardlink_to", "symlink_to"}
"""Methods of a path that write to it."""
WITH_A_TARGET = {
    "savefig", "save_file", "savez", "savez_compressed", "savetxt", "tofile", "to_csv", "to_parquet", "imsave",
    "ParquetWriter", "copyfile", "copy2", "copytree", "move", "memmap", "NamedTemporaryFile", "mkstemp",
}  # fmt: skip
"""Functions that write where an argument says."""
OF_A_MODULE = {
    ("np", "save"), ("json", "dump"), ("pickle", "dump"), ("yaml", "dump"), ("yaml", "safe_dump"), ("torch", "save"),
    ("shutil", "copy"), ("pq", "write_table"), ("parquet", "write_table"),
    ("csv", "write_csv"), ("os", "replace"), ("os", "rename"), ("os", "link"), ("os", "symlink"),
}  # fmt: skip
STREAMS = {"BytesIO", "StringIO"}
ALLOWED = {
    "siggen/file_writing.py": "the one way",
    "siggen/dataset/shard.py": "gives bytes: its sinks are buffers",
    "siggen/sets/set_files.py": "a file without a name, which ends with its process",
    "siggen/cli/opened_log.py": "a log, to which lines are added",
    "siggen/compiled.py": "the cache of the compiler",
    "diagnostics/base/reading_process.py": "a folder of its own that is deleted at once",
    "diagnostics/recordings/columns_apart.py": "the same",
}


def writes(path: Path) -> Iterator[str]:
    """Yield every call that writes to something else than a draft or a stream in memory."""
    names = {"draft", *streams(path)}
    names |= opened(path, names)
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Call) and _writes(node) and not _goes_to(node, names):
            yield f"line {node.lineno}: {ast.unparse(node)[:80]}"


def streams(path: Path) -> set[str]:
    """Return names that are bound to a stream in memory."""
    found = set()
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and _name(node.value) in STREAMS:
            found |= {target.id for target in node.targets if isinstance(target, ast.Name)}
        if isinstance(node, ast.arg) and node.annotation is not None and ast.unparse(node.annotation) in STREAMS:
            found.add(node.arg)
    return found


def opened(path: Path, names: set[str]) -> set[str]:
    """Return names of files that are opened from drafts."""
    items = [item for node in ast.walk(tree(path)) if isinstance(node, ast.With) for item in node.items]
    return {
        item.optional_vars.id
        for item in items
        if isinstance(item.optional_vars, ast.Name)
        and isinstance(item.context_expr, ast.Call)
        and _goes_to(item.context_expr, names)
    }


def _writes(call: ast.Call) -> bool:
    name = _name(call)
    if name == "open":
        return any(
            isinstance(one, ast.Constant) and isinstance(one.value, str) and set(one.value) & set("wax+")
            for one in [*call.args[-1:], *(keyword.value for keyword in call.keywords if keyword.arg == "mode")]
            if isinstance(one, ast.Constant) and isinstance(one.value, str) and len(one.value) <= 3
        )
    if isinstance(call.func, ast.Attribute):
        owner = call.func.value
        last = owner.attr if isinstance(owner, ast.Attribute) else owner.id if isinstance(owner, ast.Name) else ""
        if (last, name) in OF_A_MODULE:
            return not (name in ("dump", "safe_dump") and last == "yaml" and len(call.args) < 2)
        return name in ON_A_PATH or (name in WITH_A_TARGET and not _reads(call))
    return name in WITH_A_TARGET and not _reads(call)


def _reads(call: ast.Call) -> bool:
    return any(keyword.arg == "mode" and ast.unparse(keyword.value) == "'r'" for keyword in call.keywords)


def _goes_to(call: ast.Call, names: set[str]) -> bool:
    """Tell whether the call's target is one of the names: the object of a method, or an argument."""
    owner = call.func.value if isinstance(call.func, ast.Attribute) else None
    return any(isinstance(one, ast.Name) and one.id in names for one in (owner, *call.args))


def _name(call: ast.Call) -> str:
    return call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")


def test_nothing_is_written_under_its_final_name() -> None:
    named = re.compile(rf"\b({'|'.join({*ON_A_PATH, *WITH_A_TARGET, *(name for _, name in OF_A_MODULE), 'open'})})\(")
    others = [path for path in CODE if str(path.relative_to(ROOT)) not in ALLOWED]
    paths = [path for path in others if named.search(path.read_text(encoding="utf-8"))]
    assert not (listed := offenders(paths, writes)), listed


def test_the_rule_finds_what_it_is_for(tmp_path: Path) -> None:
    code = (
        "path.write_text('')", "open(path, 'w')", "path.open('ab')", "np.save(path, a)", "figure.savefig(path)",
        "parquet.write_table(table, path)", "path.open(mode='x')", "json.dump(facts, file)", "shutil.copyfile(a, b)",
    )  # fmt: skip
    for number, line in enumerate(code):
        file = tmp_path / f"{number}.py"
        file.write_text(line)
        assert list(writes(file)), line
    allowed = tmp_path / "allowed.py"
    allowed.write_text("draft.write_text('')\nwith draft.open('wb') as file:\n    np.save(file, a)\npath.open('rb')")
    assert not list(writes(allowed))
