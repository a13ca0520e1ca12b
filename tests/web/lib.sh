# lib.sh - what the tests of the web part need, sourced after $dist is set: $here, this folder; $data, models and images
# (FACET_TEST_DATA), which may be absent.
here=$(cd "$(dirname "$0")" && pwd)
data=${FACET_TEST_DATA-$here/../../../shared/data}
skip() {
    echo "skipped: $1"
    [ -z "${CI_REQUIRES_ALL-}" ] || exit 1
    exit 77
}

# Node.js 18 or newer, and a file of the built pages.
need_node() {
    command -v node >/dev/null || skip "there is no node"
    version=$(node -p 'process.versions.node.split(".")[0]')
    [ "$version" -ge 18 ] || skip "Node.js $version is older than 18"
    [ -f "$dist/$1" ] || skip "./run web --build was not run"
}

# The same, a browser, and a package of tests/clients.
need_browser() {
    need_node "$1"
    [ -d "$here/../clients/node_modules/${2-playwright-core}" ] || skip "npm ci was not run in tests/clients"
    [ -x "${CHROMIUM:-/usr/bin/chromium}" ] || skip "there is no ${CHROMIUM:-/usr/bin/chromium}"
}
