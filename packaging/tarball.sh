#!/bin/sh
# tarball.sh FILE.tar.xz - the sources of HEAD as a release has them, without debian/: the same bytes wherever it is made.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
version=$(sh "$here/packaging/version.sh")
git -C "$here" archive --format=tar --prefix="facet-$version/" HEAD -- . ':(exclude)debian' | xz -9 -T1 >"$1"
