#!/bin/sh
# documents.sh - man pages and completions generated from the option table.
set -eu
. "$(dirname "$0")/lib.sh"

for name in facet render bake inspect compare shaders version help; do
    expect 0 --generate-man $name
    mv out $name.1
    head -1 $name.1 | grep -q '^\.TH FACET' || failed "man page $name has no title"
    if command -v groff >/dev/null; then
        groff -man -ww -Tutf8 -z $name.1 >out 2>&1
        [ ! -s out ] || failed "groff on $name.1: $(head -3 out)"
    fi
    if command -v man >/dev/null; then
        LC_ALL=C.UTF-8 MANROFFSEQ='' man -l --warnings $name.1 >/dev/null 2>err || failed "man on $name.1"
        [ ! -s err ] || failed "man warns on $name.1"
    fi
    if command -v mandoc >/dev/null; then
        mandoc -T lint -W error $name.1 >out 2>&1 || failed "mandoc on $name.1: $(head -3 out)"
    fi
done
expect 2 --generate-man nothing
expect 2 --generate-completion tcsh
for shell in bash zsh fish; do
    expect 0 --generate-completion $shell
    mv out completion.$shell
    case $shell in
    bash) check='bash -n' ;;
    zsh) check='zsh -n' ;;
    fish) check='fish --no-execute' ;;
    esac
    command -v $shell >/dev/null || continue
    $check completion.$shell || failed "$shell does not parse its completion"
done

# complete WORD...: the completions of bash for the last word
complete() {
    bash -c '. ./completion.bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _facet; printf "%s\n" "${COMPREPLY[@]}"' \
        bash "$@" | sort | tr '\n' ' '
}
if command -v bash >/dev/null; then
    touch 'a b.glb' c.gltf d.txt
    [ "$(complete facet re)" = "render " ] || failed "completion of re: $(complete facet re)"
    [ "$(complete facet render --tone-mapping = ag)" = "agx " ] || failed "completion of --tone-mapping=ag"
    [ "$(complete facet render --lights '')" = "none scene " ] || failed "completion of --lights"
    [ "$(complete facet render '')" = "a b.glb c.gltf " ] || failed "completion of models: $(complete facet render '')"
    complete facet render --env | grep -q -- '--env-rotation' || failed "completion of --env"
fi
finish
