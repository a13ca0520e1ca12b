#!/bin/sh
# python.sh BUILD COMMAND - tests of the Python package in BUILD/python, by pytest. Needs python3-pytest and python3-numpy.
set -eu
build=$1
command=$2
top=$(cd "$(dirname -- "$0")/../.." && pwd)

skip() {
    echo "$1"
    [ -z "${CI_REQUIRES_ALL-}" ] || exit 1
    exit 77
}
[ -f "$build/python/facet/_api.py" ] || skip "the Python package was not built (FACET_PYTHON; python3-pycparser)"
for python in python3 /usr/bin/python3 none; do
    [ "$python" != none ] || skip "no python3 has pytest and numpy (python3-pytest, python3-numpy)"
    "$python" -c "import pytest, numpy" 2>/dev/null && break
done

FACET_LIBRARY=$build/src/api/libfacet.so PYTHONPATH=$build/python PYTHONDONTWRITEBYTECODE=1
FACET_TEST_COMMAND=$command FACET_TEST_INCLUDE=$top/include FACET_TEST_TOP=$top
export FACET_LIBRARY PYTHONPATH PYTHONDONTWRITEBYTECODE FACET_TEST_COMMAND FACET_TEST_INCLUDE FACET_TEST_TOP
cd "$top/tests/python"
exec "$python" -m pytest -q -p no:cacheprovider -W error::facet.FacetWarning .
