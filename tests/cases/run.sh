#!/bin/sh
# run.sh FACET [CASE...] - regression tests of small inputs. A case is a folder with its inputs and a check.sh, which is
# sourced in an empty folder with the functions of tests/cli/lib.sh and $case_dir, the case's own folder. Prints a line per
# case.
set -eu
cases=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
program=$(readlink -f -- "$1")
shift
set -- "$program" "$@"
. "$cases/../cli/lib.sh"
shift
count=0
bad=
for case_dir in "$cases"/*/; do
    case_dir=${case_dir%/}
    name=$(basename "$case_dir")
    [ $# = 0 ] || case " $* " in *" $name "*) ;; *) continue ;; esac
    mkdir "$work/$name"
    cd "$work/$name"
    status=0
    . "$case_dir/check.sh"
    count=$((count + 1))
    if [ $status = 0 ]; then echo "ok      $name"; else echo "FAILED  $name"; bad="$bad $name"; fi
done
[ $count -gt 0 ] || { echo "there is no such case"; exit 1; }
[ -z "$bad" ] || { echo "of $count cases these fail:$bad"; exit 1; }
echo "all $count cases are right"
