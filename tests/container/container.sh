#!/bin/sh
# container.sh - makes the container image (packaging/container/build.sh) and renders in it as a user without rights, with a
# read-only root, no network, no /proc and an empty environment. Needs root, packages in build/package, buildah and bwrap; exit
# code 77: something is missing. BASE_TAR as there.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/../.." && pwd)
for tool in buildah bwrap; do
    command -v $tool >/dev/null 2>&1 || { echo "container: $tool is missing"; exit 77; }
done
STORAGE_DRIVER=vfs
BUILDAH_ISOLATION=chroot
export STORAGE_DRIVER BUILDAH_ISOLATION
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
sh "$here/packaging/container/build.sh" "$tmp/facet.tar" >"$tmp/log" 2>&1 || { code=$?; tail -n 20 "$tmp/log"; exit $code; }
tail -n 1 "$tmp/log"
version=$(sh "$here/packaging/version.sh")
container=$(buildah from "facet:$version")
root=$(buildah mount "$container")
echo "container: $(du -sk "$root" | cut -f1) kB unpacked"
status=0
bwrap --ro-bind "$root" / --unshare-all --uid 65534 --gid 65534 --clearenv --die-with-parent /usr/bin/facet render -o - --format png --size 64 --renderer path --samples 4 >"$tmp/a.png" || status=1
[ "$(head -c 8 "$tmp/a.png" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || { echo "container: no image"; status=1; }
bwrap --ro-bind "$root" / --unshare-all --uid 65534 --gid 65534 --clearenv --die-with-parent /usr/bin/facet version -v || status=1
[ ! -e "$root/bin/sh" ] && [ ! -e "$root/usr/bin/sh" ] || { echo "container: there is a shell"; status=1; }
user=$(buildah inspect --format '{{.OCIv1.Config.User}}' "$container")
[ "$user" = 65534:65534 ] || { echo "container: runs as $user"; status=1; }
buildah umount "$container" >/dev/null
buildah rm "$container" >/dev/null
[ "$status" = 0 ] && echo "container: renders as user 65534 with a read-only root and no network"
exit $status
