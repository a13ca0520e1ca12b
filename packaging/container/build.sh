#!/bin/sh
# build.sh [FILE.tar] - makes the container image of the packages in build/package (./run package) as an OCI archive, by default
# build/facet-container.tar. It needs buildah, or podman; no daemon. BASE names the Debian image to start from;
# BASE_TAR is an archive of a Debian 12 system (debootstrap --variant=minbase), for machines that reach no registry.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/../.." && pwd)
out=${1:-$here/build/facet-container.tar}
version=$(sh "$here/packaging/version.sh")
set -- "$here"/build/package/facet_"$version"-*.deb
[ -f "$1" ] || { echo "container: there are no packages in build/package; ./run package makes them"; exit 1; }
if command -v buildah >/dev/null 2>&1; then
    engine=buildah
    build="buildah bud"
elif command -v podman >/dev/null 2>&1; then
    engine=podman
    build="podman build"
else
    echo "container: neither buildah nor podman is installed"
    exit 77
fi
options="--label org.opencontainers.image.version=$version"
[ -z "${BASE-}" ] || options="$options --build-arg BASE=$BASE"
if [ -n "${BASE_TAR-}" ]; then
    $engine rmi facet-base >/dev/null 2>&1 || true
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    ln "$BASE_TAR" "$folder/base.tar" 2>/dev/null || cp "$BASE_TAR" "$folder/base.tar"
    printf 'FROM scratch\nADD base.tar /\n' >"$folder/Containerfile"
    $build -t facet-base "$folder"
    # packages as this machine gets them
    options="$options --build-arg BASE=localhost/facet-base --volume /etc/apt:/etc/apt:ro"
    [ ! -f "${NODE_EXTRA_CA_CERTS:-}" ] || options="$options --volume $NODE_EXTRA_CA_CERTS:$NODE_EXTRA_CA_CERTS:ro"
fi
# shellcheck disable=SC2086
$build $options -t "facet:$version" -f "$here/packaging/container/Containerfile" "$here/build/package"
rm -f "$out"
$engine push "facet:$version" "oci-archive:$out"
echo "container: $out, $(($(wc -c <"$out") / 1000)) kB compressed"
