#!/bin/sh
# Sets up what `make demo` and `make test` need: Debian packages, .venv, the locked Python packages.
# Usage: tools/setup.sh [runtime|dev]. Quick and silent when all is there.
set -eu
cd "$(dirname "$0")/.."
part=${1:-runtime}
case $part in
    runtime) lock=requirements.lock ;;
    dev) lock=requirements-dev.lock ;;
    *) echo "usage: tools/setup.sh [runtime|dev]" >&2; exit 2 ;;
esac

say() { echo "set-up: $*" >&2; }

find_python() {
    for candidate in ${PYTHON:-} python3 python3.14 python3.13 python3.12 python3.11; do
        if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            echo "$candidate"
            return
        fi
    done
    say "Python 3.11 or newer is needed; none of python3, python3.11 ... python3.14 is (set PYTHON=...)"
    return 1
}

missing_packages() {
    command -v swipl >/dev/null || echo swi-prolog-nox
    if command -v dpkg-query >/dev/null; then
        installed=" $(dpkg-query -W -f '${Package}/${db:Status-Status} ' 2>/dev/null) "
        # Off-screen OpenGL: the EGL and GL loaders and Mesa's software driver.
        for package in libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri; do
            case $installed in *" $package/installed "*) ;; *) echo "$package" ;; esac
        done
    fi
    # A usable environment needs no ensurepip any more; a new one does.
    if [ ! -x .venv/bin/python ] && ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
        # A Python that is not Debian's own default needs its numbered package.
        "$python" -c 'import sys; print(f"python{sys.version_info[0]}.{sys.version_info[1]}-venv")'
    fi
}

install_packages() {
    if ! command -v apt-get >/dev/null; then
        say "please install by your system's means: $*"
        exit 2
    fi
    sudo=
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || { say "as root, run: apt-get install $*"; exit 2; }
        sudo=sudo
    fi
    say "installing Debian packages${sudo:+ through sudo}: $*"
    apt_install() { $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >"$apt_log" 2>&1; }
    apt_log=$(mktemp)
    # The lists of a fresh machine are empty or old: they are fetched only when the first try fails.
    if ! apt_install "$@"; then
        say "updating the package lists"
        if ! $sudo apt-get update -qq >"$apt_log" 2>&1 || ! apt_install "$@"; then
            tail -n 15 "$apt_log" >&2
            rm -f "$apt_log"
            say "apt-get install $* failed; its last lines are above"
            exit 2
        fi
    fi
    rm -f "$apt_log"
}

python=$(find_python)
packages=$(missing_packages)
# shellcheck disable=SC2086 # a list of words
[ -z "$packages" ] || install_packages $packages

# The development lock contains the runtime lock, so its stamp answers for both.
wanted() { cat pyproject.toml "$1" | sha256sum | cut -d ' ' -f 1; }
done_with() { [ -x .venv/bin/python ] && [ "$(cat ".venv/.set-up-$1" 2>/dev/null)" = "$(wanted "$2")" ]; }
if done_with dev requirements-dev.lock || { [ "$part" = runtime ] && done_with runtime requirements.lock; }; then
    exit 0
fi

if ! .venv/bin/python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
    say "creating .venv with $("$python" --version)"
    rm -rf .venv
    "$python" -m venv .venv
fi
.venv/bin/python -c 'import pip' 2>/dev/null || .venv/bin/python -m ensurepip --upgrade >/dev/null
say "installing the Python packages of $lock into .venv (once; some minutes at most)"
pip() { .venv/bin/python -m pip -qq --disable-pip-version-check "$@" >&2; }
pip install --require-hashes --no-deps -r "$lock"
pip install --no-deps --no-build-isolation -e .
wanted "$lock" >".venv/.set-up-$part"
