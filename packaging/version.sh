#!/bin/sh
# version.sh - prints the version, which include/facet/base.h has.
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
awk '/define FACET_VERSION_[MP]/ {printf "%s%s", point, $3; point = "."} END {print ""}' "$here/include/facet/base.h"
