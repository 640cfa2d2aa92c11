"""The filter of system calls: what SWI-Prolog needs to compute and to answer on its socket, and nothing else.

A call that is not on the list fails as on a system that does not have it, so that libraries fall back on older ones.

Source:
    seccomp(2), and ``linux/filter.h`` and ``linux/seccomp.h`` for the numbers. The list was drawn up from traces of
    all tests that ask Prolog.
"""

from __future__ import annotations

import ctypes
import errno
import os
import platform
import struct

from prolepsis.logic.confinement.landlock import PR_SET_NO_NEW_PRIVS, libc

ARCHITECTURES = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
"""Machines whose calls are numbered below, with the number by which the kernel knows them."""

# x86_64, aarch64; None where the machine has no such call.
NUMBERS: dict[str, tuple[int | None, int | None]] = {
    # Memory.
    "brk": (12, 214),
    "madvise": (28, 233),
    "membarrier": (324, 283),
    "mmap": (9, 222),
    "mprotect": (10, 226),
    "mremap": (25, 216),
    "munmap": (11, 215),
    # Open files, and looking at files; Landlock or bubblewrap says which.
    "access": (21, None),
    "close": (3, 57),
    "dup": (32, 23),
    "dup2": (33, None),
    "dup3": (292, 24),
    "faccessat": (269, 48),
    "faccessat2": (439, 439),
    "fcntl": (72, 25),
    "fstat": (5, 80),
    "getcwd": (79, 17),
    "getdents64": (217, 61),
    "lseek": (8, 62),
    "lstat": (6, None),
    "newfstatat": (262, 79),
    "poll": (7, None),
    "ppoll": (271, 73),
    "pread64": (17, 67),
    "pselect6": (270, 72),
    "read": (0, 63),
    "readlink": (89, None),
    "readlinkat": (267, 78),
    "readv": (19, 65),
    "select": (23, None),
    "stat": (4, None),
    "write": (1, 64),
    "writev": (20, 66),
    # Threads, signals and time of this process.
    "arch_prctl": (158, None),
    "clock_getres": (229, 114),
    "clock_gettime": (228, 113),
    "clock_nanosleep": (230, 115),
    "exit": (60, 93),
    "exit_group": (231, 94),
    "futex": (202, 98),
    "getegid": (108, 177),
    "geteuid": (107, 175),
    "getgid": (104, 176),
    "getpid": (39, 172),
    "getppid": (110, 173),
    "getrandom": (318, 278),
    "getrusage": (98, 165),
    "gettid": (186, 178),
    "gettimeofday": (96, 169),
    "getuid": (102, 174),
    "nanosleep": (35, 101),
    "restart_syscall": (219, 128),
    "rseq": (334, 293),
    "rt_sigaction": (13, 134),
    "rt_sigprocmask": (14, 135),
    "rt_sigreturn": (15, 139),
    "rt_sigsuspend": (130, 133),
    "rt_sigtimedwait": (128, 137),
    "sched_getaffinity": (204, 123),
    "sched_yield": (24, 124),
    "set_robust_list": (273, 99),
    "set_tid_address": (218, 96),
    "sigaltstack": (131, 132),
    "sysinfo": (99, 179),
    "time": (201, None),
    "times": (100, 153),
    "uname": (63, 160),
    # The socket on which it answers. It may accept, and not connect.
    "accept": (43, 202),
    "accept4": (288, 242),
    "bind": (49, 200),
    "getpeername": (52, 205),
    "getsockname": (51, 204),
    "getsockopt": (55, 209),
    "listen": (50, 201),
    "recvfrom": (45, 207),
    "setsockopt": (54, 208),
    "shutdown": (48, 210),
}
"""Calls that are allowed with any arguments."""

# Calls that are allowed with some arguments only.
CLONE, EXECVE, IOCTL, OPEN, OPENAT, PRCTL, PRLIMIT, SENDTO, SOCKET, TGKILL = range(10)
WITH_ARGUMENTS: dict[int, tuple[int | None, int | None]] = {
    CLONE: (56, 220),
    EXECVE: (59, 221),
    IOCTL: (16, 29),
    OPEN: (2, None),
    OPENAT: (257, 56),
    PRCTL: (157, 167),
    PRLIMIT: (302, 261),
    SENDTO: (44, 206),
    SOCKET: (41, 198),
    TGKILL: (234, 131),
}

CLONE_THREAD = 0x00010000
AF_UNIX = 1
PR_SET_NAME, PR_GET_NAME = 15, 16
IOCTLS = (0x5401, 0x5421, 0x541B, 0x5413)
"""TCGETS, FIONBIO, FIONREAD, TIOCGWINSZ: whether it is a terminal, and how to wait for a socket."""
WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND

# Instructions of the filter's machine.
LOAD, EQUAL, ANY_BIT, AT_LEAST, RETURN = 0x20, 0x15, 0x45, 0x35, 0x06
ALLOW, ERROR = 0x7FFF0000, 0x00050000
NR, ARCH, ARGUMENTS = 0, 4, 16
"""Where the number, the architecture and the arguments of a call stand [bytes]."""

PR_SET_SECCOMP, SECCOMP_MODE_FILTER = 22, 2
SECCOMP, SECCOMP_GET_ACTION_AVAIL = {"x86_64": 317, "aarch64": 277}, 2


def can_filter() -> bool:
    """Return whether this kernel filters system calls, and the calls of this machine are known."""
    machine = platform.machine()
    if machine not in ARCHITECTURES:
        return False
    action = ctypes.c_uint32(ERROR)
    return libc().syscall(SECCOMP[machine], SECCOMP_GET_ACTION_AVAIL, 0, ctypes.byref(action)) == 0


def program(process: int, path: int | None) -> bytes:
    """Return the filter as the kernel reads it, eight bytes an instruction.

    Args:
        process: Number of this process, the only one that it may signal.
        path: Address of the one path that it may execute; ``None`` lets it execute what it finds.
    """
    column = list(ARCHITECTURES).index(platform.machine())

    def argument(number: int, *, high: bool = False) -> bytes:
        return _instruction(LOAD, ARGUMENTS + 8 * number + 4 * high)

    def refuse(code: int) -> bytes:
        return _instruction(RETURN, ERROR | code)

    def nothing(number: int) -> bytes:
        """Go on if an argument is a null pointer; else pass over the next instruction."""
        return (
            argument(number) + _instruction(EQUAL, 0, 0, 3) + argument(number, high=True) + _instruction(EQUAL, 0, 0, 1)
        )

    allow, absent, denied = _instruction(RETURN, ALLOW), refuse(errno.ENOSYS), refuse(errno.EPERM)
    rules: dict[int, bytes] = {
        CLONE: argument(0) + _instruction(ANY_BIT, CLONE_THREAD, 0, 1) + allow + denied,
        IOCTL: argument(1) + b"".join(_instruction(EQUAL, number, 0, 1) + allow for number in IOCTLS) + denied,
        OPEN: argument(1) + _instruction(ANY_BIT, WRITING, 0, 1) + refuse(errno.EACCES) + allow,
        OPENAT: argument(2) + _instruction(ANY_BIT, WRITING, 0, 1) + refuse(errno.EACCES) + allow,
        PRCTL: argument(0)
        + b"".join(_instruction(EQUAL, option, 0, 1) + allow for option in (PR_SET_NAME, PR_GET_NAME))
        + denied,
        # Limits may be read, not set, and words are sent to who has connected, not to an address.
        PRLIMIT: nothing(2) + allow + denied,
        SENDTO: nothing(4) + allow + denied,
        SOCKET: argument(0) + _instruction(EQUAL, AF_UNIX, 0, 1) + allow + denied,
        TGKILL: argument(0) + _instruction(EQUAL, process, 0, 1) + allow + denied,
    }
    if path is None:
        rules[EXECVE] = allow
    else:
        rules[EXECVE] = (
            argument(0)
            + _instruction(EQUAL, path & 0xFFFFFFFF, 0, 3)
            + argument(0, high=True)
            + _instruction(EQUAL, path >> 32, 0, 1)
            + allow
            + denied
        )
    body = _instruction(LOAD, ARCH) + _instruction(EQUAL, ARCHITECTURES[platform.machine()], 1, 0) + denied
    # Calls of the 32-bit kind of x86_64 have numbers from here on.
    body += _instruction(LOAD, NR) + _instruction(AT_LEAST, 0x40000000, 0, 1) + absent
    for numbers in NUMBERS.values():
        number = numbers[column]
        if number is not None:
            body += _instruction(EQUAL, number, 0, 1) + allow
    for call, numbers in WITH_ARGUMENTS.items():
        number = numbers[column]
        if number is not None:
            body += _instruction(EQUAL, number, 0, len(rules[call]) // 8) + rules[call]
    return body + absent


def _instruction(code: int, value: int, if_true: int = 0, if_false: int = 0) -> bytes:
    return struct.pack("=HBBI", code, if_true, if_false, value)


def confine(filter_program: bytes) -> None:
    """Let this process, and what it becomes, make only the calls that the filter allows.

    Raises:
        OSError: If the kernel refuses the filter.
    """
    instructions = ctypes.create_string_buffer(filter_program)
    head = struct.pack("@HxxxxxxP", len(filter_program) // 8, ctypes.addressof(instructions))
    _prctl(PR_SET_NO_NEW_PRIVS, 1)
    _prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, ctypes.create_string_buffer(head))


def _prctl(option: int, *arguments: int | ctypes.Array[ctypes.c_char]) -> None:
    padded = [a if isinstance(a, ctypes.Array) else ctypes.c_ulong(a) for a in (*arguments, 0, 0, 0)[:4]]
    if libc().prctl(option, *padded) != 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))
