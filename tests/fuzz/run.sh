#!/bin/sh
# run.sh [TARGET] [MINUTES] - builds the fuzzing targets with libFuzzer and the address and undefined behaviour sanitizers, and
# runs TARGET, or each in turn, for MINUTES (1). Inputs that reach new code are kept in build/fuzz/found/TARGET for the
# next run; a failing input is reported, kept as build/fuzz/failed/TARGET-.., and makes the exit code 1.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
build=$here/../../build/fuzz
target=all
minutes=1
for word in "$@"; do
    case $word in
    *[!0-9.]*) target=$word ;;
    *) minutes=$word ;;
    esac
done
seconds=$(awk "BEGIN { printf \"%d\", 60 * $minutes }")
names=$(sed -n 's/^ *facet_fuzz(\([a-z0-9_]*\) .*/\1/p' "$here/CMakeLists.txt")
[ "$target" = all ] || {
    echo "$names" | grep -qx "$target" || { echo "fuzz: no target $target; there are" $names >&2; exit 2; }
    names=$target
}

mkdir -p "$build/failed"
cmake -S "$here/../.." -B "$build" -G Ninja -DCMAKE_C_COMPILER=clang -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_C_FLAGS_RELWITHDEBINFO="-O1 -g1 -DNDEBUG" -DFACET_SANITIZE=address,undefined -DFACET_FUZZ=ON \
    -DFACET_BENCH=OFF >"$build/build.log" 2>&1 || { tail -n 20 "$build/build.log"; exit 1; }
programs=
for name in $names; do programs="$programs fuzz_$name"; done
cmake --build "$build" -t $programs >>"$build/build.log" 2>&1 || { tail -n 40 "$build/build.log"; exit 1; }

status=0
for name in $names; do
    found=$build/found/$name
    log=$build/$name.log
    mkdir -p "$found"
    dictionary=
    [ ! -f "$here/$name.dict" ] || dictionary=-dict=$here/$name.dict
    code=0
    LSAN_OPTIONS="suppressions=$here/../lsan.supp:print_suppressions=0" "$build/tests/fuzz/fuzz_$name" \
        -max_total_time="$seconds" -timeout=30 -rss_limit_mb=4096 -print_final_stats=1 -verbosity=1 $dictionary \
        -artifact_prefix="$build/failed/$name-" "$found" $(cat "$build/tests/fuzz/$name.corpora") >"$log" 2>&1 || code=$?
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    coverage=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
    if [ $code = 0 ]; then
        echo "ok      $name: ${runs:-?} inputs in $seconds s, ${coverage:-?} edges"
    else
        echo "FAILED  $name: $(grep -m 1 -E 'ERROR|SUMMARY|runtime error' "$log" || echo "exit code $code"); see $log"
        status=1
    fi
done
exit $status
