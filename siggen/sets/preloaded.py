"""What the fork server imports, so that its copies have it; and the end of that server with its driver."""

from __future__ import annotations

import os

from siggen.uncollected import uncollected
from siggen.workers.orphan import end_with
from siggen.workers.process_pool import DRIVER

if os.environ.get(DRIVER, "") == str(os.getppid()):
    end_with(os.getppid())
    with uncollected():
        from siggen.sets import drawn, shard_making

    IMPORTED = (drawn, shard_making)
