#!/bin/sh
# install.sh [FOLDER] - installs the packages of build/package in a new Debian 12 (debootstrap), renders, draws thumbnails, imports
# the Python package, upgrades and removes them, and prints the times. Needs root and debootstrap. FOLDER (a new one below
# /var/tmp) keeps the system for the next run; MIRROR names another Debian mirror. The chroot uses the apt settings and the certificates of this machine.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
[ "$(id -u)" = 0 ] || { echo "install: chroot and mount need root"; exit 1; }
folder=${1:-$(mktemp -d /var/tmp/facet-install-XXXXXX)}
. "$here/packaging/system.sh"
system_create "$folder"
rm -rf "$folder/packages"
mkdir -p "$system/root/packages" "$system/root/upgrade" "$folder/packages"
cp "$here"/build/package/*.deb "$system/root/packages/"
rm -f "$system"/root/packages/*-dbgsym_*
# The same packages as the next revision.
for package in "$system"/root/packages/*.deb; do
    dpkg-deb -R "$package" "$folder/packages/tree"
    version=$(dpkg-deb -f "$package" Version)
    sed -i "s/$version/${version}0/g" "$folder/packages/tree/DEBIAN/control"
    dpkg-deb -b "$folder/packages/tree" "$system/root/upgrade/" >/dev/null
    rm -rf "$folder/packages/tree"
done
cp "$here/docs/examples/obj/boat.obj" "$here/docs/examples/obj/boat.mtl" "$system/root/"

step() { # NAME COMMAND
    begin=$(date +%s.%N)
    system_run "$2" >"$folder/log" 2>&1 || { tail -n 20 "$folder/log"; echo "install: $1 failed"; exit 1; }
    echo "install: $1: $(echo "$(date +%s.%N) - $begin" | bc -l | cut -c1-5) s"
}
apt="DEBIAN_FRONTEND=noninteractive apt-get -y --no-install-recommends"
step "lists of packages" "apt-get update"
step "download of what facet needs" "$apt --download-only install ./packages/facet_*.deb ./packages/libfacet0_*.deb"
step "install facet" "$apt install ./packages/facet_*.deb ./packages/libfacet0_*.deb"
step "facet render" "facet render -o a.png && test -s a.png"
step "a path-traced image" "facet render -o a.png --size 64 --renderer path --samples 4"
system_run "facet version -v" | grep 'avif\|cairo\|http'
step "install the others" "$apt install ./packages/*.deb libgl1-mesa-dri bubblewrap python3-numpy"
used='facet render -o b.png --size 64 --renderer gl && test -s b.png && facet-thumbnailer -s 128 boat.obj t.png && test -s t.png &&
    python3 -c "import facet; assert facet.load(\"boat.obj\").render(size=(64, 64)).shape[:2] == (64, 64)"'
step "OpenGL, a thumbnail, Python" "$used"
step "upgrade" "$apt install ./upgrade/*.deb"
step "the same after it" "$used"
step "back to the former revision" "$apt --allow-downgrades install ./packages/*.deb"
step "purge" "$apt purge facet libfacet0 libfacet-dev facet-gl facet-doc python3-facet facet-thumbnailer"
left=$(find "$system/usr" "$system/etc" "$system/var/lib" -name '*facet*' ! -path '*/dpkg/*' ! -path '*/apt/*' | head)
[ -z "$left" ] || { echo "install: left behind: $left"; exit 1; }
echo "install: nothing is left behind"
