#!/bin/sh
# serve.sh - facet serve and its clients in Node.js. usage: serve.sh FACET rpc|http|mcp
# Skipped, or failed where CI_REQUIRES_ALL is set, without Node.js 18 or newer, libmicrohttpd in the build (http), and npm ci
# in this folder (mcp).
set -eu
facet=$1
part=$2
here=$(cd "$(dirname "$0")" && pwd)

skip() {
    echo "skipped: $1"
    [ -z "${CI_REQUIRES_ALL-}" ] || exit 1
    exit 77
}

command -v node >/dev/null || skip "there is no node"
version=$(node -p 'process.versions.node.split(".")[0]')
[ "$version" -ge 18 ] || skip "Node.js $version is older than 18"
[ "$part" != mcp ] || [ -d "$here/node_modules/@modelcontextprotocol/sdk" ] || skip "npm ci was not run in tests/serve"
[ "$part" != http ] || "$facet" version -v | grep -q '^http .*libmicrohttpd' || skip "this build is without libmicrohttpd"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
TMPDIR=$work/tmp
mkdir "$TMPDIR"
export TMPDIR
node "$here/$part.mjs" "$facet" "$work"
[ -z "$(ls -A "$TMPDIR")" ] || { echo "temporary files are left: $(ls "$TMPDIR")"; exit 1; }
