#!/usr/bin/env bash
# Makes the checkout runnable: the system's libraries that Qt and OpenGL need (Debian and its
# kin), and the program in a virtual environment, .venv.
#
#   bash setup.sh        to use it
#   bash setup.sh dev    to work on it: also what tests and checks need
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

extra=${1:-}
packages=()

want() { # a package of Debian, unless it is there
  dpkg-query -W -f '${Status}' "$1" 2>/dev/null | grep -q 'ok installed' || packages+=("$1")
}

install_packages() {
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null || { ! sudo -n true 2>/dev/null && [ ! -t 0 ]; }; then
      echo "setup: not root; please install: apt-get install ${packages[*]}" >&2
      return 0
    fi
    as_root=(sudo)
  fi
  echo "setup: installing ${packages[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y \
    --no-install-recommends "${packages[@]}" >/dev/null
}

find_python() {
  local candidate
  for candidate in "${PYTHON:-python3}" python3.14 python3.13 python3.12 python3.11; do
    if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
      command -v "$candidate"
      return
    fi
  done
  echo "setup: Python 3.11 or later is needed" >&2
  return 1
}

python=$(find_python)

if command -v apt-get >/dev/null; then
  for package in $(awk '!/^#/ && !seen[$2]++ { print $2 }' resources/system/debian-packages.txt); do
    want "$package"
  done
  [ "$extra" != dev ] || { want xvfb; want xauth; }
  # Debian splits what makes an environment off the Python of its own.
  "$python" -c 'import ensurepip' 2>/dev/null || packages+=(python3-venv)
  [ ${#packages[@]} -eq 0 ] || install_packages
fi

[ -x .venv/bin/python ] || "$python" -m venv .venv
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_ROOT_USER_ACTION=ignore
.venv/bin/python -m pip install -q --retries 10 --timeout 60 -e ".${extra:+[$extra]}"
# Without bytecode the program takes twice as long to start.
.venv/bin/python -m compileall -q mocapstudio
echo "setup: done; start it with .venv/bin/mocapstudio"
