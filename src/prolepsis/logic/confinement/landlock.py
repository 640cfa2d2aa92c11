"""Landlock: a process gives up all files but some, all of the network, and signals to others. No privilege is needed.

Source:
    landlock(7) and ``linux/landlock.h``; a newer kernel knows more rights, and all that it knows are given up.
"""

from __future__ import annotations

import ctypes
import os
import struct
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

CREATE, ADD_RULE, RESTRICT = 444, 445, 446
"""Numbers of the system calls, the same on every machine."""
PR_SET_NO_NEW_PRIVS = 38
VERSION = 1
PATH_BENEATH = 1

EXECUTE, READ_FILE, READ_DIR, MAKE_SOCKET = 1 << 0, 1 << 2, 1 << 3, 1 << 9
READ = READ_FILE | READ_DIR
OF_FILES = EXECUTE | READ_FILE
"""Rights that a single file can be given."""
RIGHTS = (0, 13, 14, 15, 15, 16, 16)
"""Number of rights to files that each version of Landlock knows; newer ones know at least those of the last."""
NETWORK, SCOPES = 0b11, 0b11
"""Binding and connecting of TCP, from version 4; abstract sockets and signals, from version 6."""


@lru_cache(maxsize=1)
def libc() -> Any:
    """Return the C library, whose calls set ``ctypes.get_errno``."""
    return ctypes.CDLL(None, use_errno=True)


def version() -> int:
    """Return the version of Landlock that the kernel offers, 0 for none."""
    return max(0, int(libc().syscall(CREATE, None, ctypes.c_size_t(0), VERSION)))


def confine(allowed: Mapping[str, int]) -> None:
    """Give up everything but the rights to some paths; for good, and for what this process becomes, too.

    Args:
        allowed: Path to its rights; a folder's are those of all below it. Paths that do not exist are passed over.

    Raises:
        OSError: If the kernel refuses.
    """
    known = version()
    files = (1 << RIGHTS[min(known, len(RIGHTS) - 1)]) - 1
    network = NETWORK if known >= 4 else 0
    scopes = SCOPES if known >= 6 else 0
    attributes = struct.pack("=QQQ", files, network, scopes)[: 24 if known >= 6 else 16 if known >= 4 else 8]
    rules = _checked(libc().syscall(CREATE, attributes, ctypes.c_size_t(len(attributes)), 0))
    for path, rights in allowed.items():
        try:
            descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC)
        except OSError:
            continue
        if not os.path.isdir(path):
            rights &= OF_FILES
        rule = struct.pack("=Qi", rights & files, descriptor)
        _checked(libc().syscall(ADD_RULE, rules, PATH_BENEATH, rule, 0))
        os.close(descriptor)
    _checked(libc().prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0))
    _checked(libc().syscall(RESTRICT, rules, 0))
    os.close(rules)


def _checked(result: int) -> int:
    if result < 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))
    return result
