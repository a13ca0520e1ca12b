#!/bin/sh
# sources.sh FOLDER NAME... - Debian's sources of libraries, with Debian's patches, as FOLDER/NAME: downloaded once, checked by
# apt's signatures. The system's list of sources stays as it is. Exit code 77: a download failed.
set -eu
folder=$1
shift
mkdir -p "$folder/apt/lists/partial" "$folder/apt/archives/partial"
folder=$(cd "$folder" && pwd)
list=$folder/apt/deb-src.list
mirror=$(sed -n 's/^URIs: *//p; s/^deb \(\[[^]]*\] \)\{0,1\}\([^ ]*\) .*/\2/p' /etc/apt/sources.list.d/*.sources /etc/apt/sources.list 2>/dev/null | head -n 1)
suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-bookworm}")
echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] ${mirror:-http://deb.debian.org/debian} $suite main" >"$list"
apt() {
    apt-get -o Dir::Etc::SourceList="$list" -o Dir::Etc::SourceParts=- -o Dir::State::Lists="$folder/apt/lists" \
        -o Dir::Cache::Archives="$folder/apt/archives" -o Dir::Cache::srcpkgcache= -o Dir::Cache::pkgcache= \
        -o APT::Sandbox::User= "$@"
}
is_updated=
for name; do
    [ -d "$folder/$name" ] && continue
    [ -n "$is_updated" ] || apt update >"$folder/apt/log" 2>&1 || true
    is_updated=1
    rm -rf "$folder/apt/$name"
    mkdir "$folder/apt/$name"
    (cd "$folder/apt/$name" && apt source --download-only "$name" && dpkg-source -x ./*.dsc source) >>"$folder/apt/log" 2>&1 || {
        tail -n 5 "$folder/apt/log" >&2
        echo "web: Debian's source of $name could not be had" >&2
        exit 77
    }
    mv "$folder/apt/$name/source" "$folder/$name"
done
