#!/bin/sh
# fresh.sh - the README's two commands on a Debian 12 with nothing installed: a debootstrap of variant minbase, a clone of
# this checkout's HEAD in it, then ./run render and ./run test in a chroot with /proc and /dev of its own. Prints the time of
# each, and skipped tests. Needs root, debootstrap, git, and some 6 GB of disk.
#
#     tests/fresh.sh [FOLDER]    FOLDER (a new one below /var/tmp) keeps the chroot and its packages for the next run
#
# MIRROR names another Debian mirror. FACET_TEST_DATA, if set, is visible to the tests. The chroot uses the apt sources and
# settings and the certificates of this machine.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
[ "$(id -u)" = 0 ] || { echo "fresh: chroot and mount need root"; exit 1; }
for tool in debootstrap git unshare chroot; do
    command -v $tool >/dev/null || { echo "fresh: $tool is missing"; exit 1; }
done
folder=${1:-$(mktemp -d /var/tmp/facet-fresh-XXXXXX)}
. "$here/packaging/system.sh"
system_create "$folder"

git clone -q "$here" "$system/root/facet"
data=
if [ -n "${FACET_TEST_DATA:-}" ]; then
    data=/root/data
    mkdir "$system$data"
fi

# inside SECONDS_FILE COMMAND: runs it in the clone. Mounts are those of a namespace that ends with it.
inside() {
    begin=$(date +%s)
    code=0
    unshare --mount --pid --fork sh -euc '
        mount --make-rprivate /
        mount -t proc proc "$1/proc"
        mount --rbind /dev "$1/dev"
        [ -z "$3" ] || { mount --bind "$FACET_TEST_DATA" "$1$3"; mount -o remount,bind,ro "$1$3"; }
        exec chroot "$1" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
            ${4:+NODE_EXTRA_CA_CERTS="$4"} ${3:+FACET_TEST_DATA="$3"} sh -c "cd /root/facet && $2"
    ' sh "$system" "$1" "$data" "$certificates" || code=$?
    echo "fresh: $1: exit $code, $(($(date +%s) - begin)) s"
    return $code
}

status=0
inside "./run render -o image.png" || status=1
[ -s "$system/root/facet/image.png" ] || { echo "fresh: ./run render left no image"; status=1; }
inside "./run test" >"$folder/test.log" 2>&1 || status=1
tail -n 40 "$folder/test.log"
if grep -E '\*\*\*Skipped|\(Skipped\)' "$folder/test.log"; then
    echo "fresh: the tests above were skipped"
    [ -z "$data" ] || status=1
fi
echo "fresh: $(chroot "$system" dpkg-query -f '.\n' -W | wc -l) packages, log in $folder/test.log"
exit $status
