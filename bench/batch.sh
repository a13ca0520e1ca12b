#!/bin/sh
# batch.sh - the measures of docs/batch.md: thumbnails per second and CPU second of facet batch beside separate processes, and beside
# f3d if it is installed; scaling; memory over many items; broken items; random kills. docs/serve.md has the browser.
#     sh bench/batch.sh FACET MODELS rate|scale|flat|poison|kill [COUNT]
set -eu
facet=$1 models=$2 what=$3 count=${4:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
options="--size 256"

now() {
    date +%s.%N
}

# report LABEL ITEMS BEGIN: items per second since BEGIN, and processor seconds of all children of this shell since the last report.
report() {
    items=$2 began=$3 ended=$(now)
    used=$(awk '{ print ($16 + $17) / 100 }' /proc/$$/stat)
    awk -v l="$1" -v n="$items" -v a="$began" -v b="$ended" -v u="$used" -v v="${used_before:-0}" \
        'BEGIN { printf "%-32s %6.1f items/s  %.3f core s an item  %.1f items/s and core\n", l, n / (b - a), (u - v) / n, n / (u - v) }'
    used_before=$used
}

# manifest COUNT [POISON_EVERY]: small models again and again, with one view each; some are broken, one hangs.
manifest() {
    find "$models" -name 'Box.glb' -o -name 'Avocado.glb' -o -name 'Fox.glb' -o -name 'SimpleMorph.glb' | sort >small
    echo 'no model' >broken.gltf
    mkfifo hang.gltf
    awk -v n="$1" -v every="${2:-0}" -v size="${size:-64}" '{ model[NR - 1] = $0 } END { for (i = 0; i < n; i++) {
        input = every && i % every == every / 2 ? "broken.gltf" : model[i % NR]
        if (every && i == 777) input = "hang.gltf"
        printf "{\"input\":\"%s\",\"output\":\"o/%d/%d.png\",\"orbit\":\"%d,75,105%%\",\"size\":%d}\n", input, i % 100, i, i % 360, size
    } }' small >jobs.jsonl
}

case $what in
rate)
    find "$models" \( -name '*.glb' -o -name '*.gltf' \) ! -path '*gltf1*' | sort >list
    n=$(wc -l <list)
    began=$(now)
    "$facet" batch --files-from list -o 'b/{index}.png' -q -j "$(nproc)" -- $options
    report "facet batch -j $(nproc)" "$n" "$began"
    began=$(now) i=0
    mkdir s
    while read -r model; do
        i=$((i + 1))
        "$facet" render "$model" -o s/$i.png -q $options
    done <list
    report "facet render, one after another" "$n" "$began"
    if command -v f3d >/dev/null && command -v xvfb-run >/dev/null; then
        began=$(now) i=0 good=0
        mkdir f
        while read -r model; do
            i=$((i + 1))
            timeout 60 xvfb-run -a f3d "$model" --output f/$i.png --resolution 256,256 >/dev/null 2>&1 </dev/null || true
            [ -s f/$i.png ] && good=$((good + 1))
        done <list
        report "f3d under xvfb ($good of $n)" "$n" "$began"
    fi
    ;;
scale)
    size=256
    manifest "${count:-400}"
    for jobs in 1 2; do
        rm -rf o
        began=$(now)
        "$facet" batch --manifest jobs.jsonl -j $jobs -q -- --threads 1
        report "-j $jobs" "${count:-400}" "$began"
    done
    ;;
flat)
    manifest "${count:-5000}"
    began=$(now)
    "$facet" batch --manifest jobs.jsonl -q --results r.jsonl &
    process=$!
    while kill -0 $process 2>/dev/null; do
        sleep 5
        lines=$(wc -l <r.jsonl 2>/dev/null || echo 0)
        awk -v n="$lines" '/^VmRSS|^VmHWM/ { printf "%s %d KiB  ", $1, $2 } END { print n " items" }' /proc/$process/status 2>/dev/null || true
    done
    wait $process
    report "facet batch" "${count:-5000}" "$began"
    ;;
poison)
    n=${count:-5000}
    manifest "$n" 100
    code=0
    "$facet" batch --manifest jobs.jsonl --results r.jsonl -q --time-limit 5s 2>err || code=$?
    echo "exit $code: $(grep -c '"status":"done"' r.jsonl) done, $(grep -c '"status":"failed"' r.jsonl) failed," \
        "$(find o -type f | wc -l) files of $n items, $(find o -type f ! -name '*.png' | wc -l) temporary"
    ;;
kill)
    # one batch, killed at random moments until it is done, again and again; its outputs are those of an undisturbed run
    rounds=${count:-300}
    manifest 60
    "$facet" batch --manifest jobs.jsonl -q
    mv o whole
    round=0 runs=0 seed=7
    while [ $round -lt "$rounds" ]; do
        rm -rf o r.jsonl
        while :; do
            "$facet" batch --manifest jobs.jsonl --results r.jsonl --resume -q &
            process=$!
            seed=$(((seed * 1103515245 + 12345) % 2147483648))
            sleep "0.$(printf '%03d' $((seed / 65536 % 900)))"
            runs=$((runs + 1))
            if kill -9 $process 2>/dev/null; then
                round=$((round + 1))
            else
                wait $process && break
            fi
            wait $process 2>/dev/null || true
            [ $round -lt "$rounds" ] || { "$facet" batch --manifest jobs.jsonl --results r.jsonl --resume -q; break; }
        done
        diff -r o whole >/dev/null || { echo "other outputs after a kill"; exit 1; }
        "$facet" batch --manifest jobs.jsonl --results r.jsonl --verify -q || { echo "items are missing"; exit 1; }
    done
    echo "$round kills in $runs runs: all outputs complete and equal, no temporary files"
    ;;
esac
