#!/bin/sh
# sbom.sh FACET LIBRARY... - the list of libraries of a release is SPDX 2.3, and has every library that LIBRARY, libfacet and its
# module, is linked with.
set -eu
facet=$1
shift
here=$(cd "$(dirname -- "$0")/../.." && pwd)
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
fail() {
    echo "sbom: $*"
    exit 1
}
for tool in jq readelf; do
    command -v $tool >/dev/null 2>&1 || { echo "sbom: $tool is missing"; exit 77; }
done
sh "$here/packaging/sbom.sh" "$facet" >"$tmp/sbom.json"
jq -e '. as $all | [.packages[].SPDXID] as $ids
    | .spdxVersion == "SPDX-2.3" and .dataLicense == "CC0-1.0" and .SPDXID == "SPDXRef-DOCUMENT" and (.name | length > 0)
    and (.documentNamespace | test("^[a-z]+:[^#]+$")) and (.creationInfo.created | test("^[0-9-]{10}T[0-9:]{8}Z$"))
    and (.creationInfo.creators | length > 0) and ($ids | length) == ($ids | unique | length)
    and all(.packages[]; (.SPDXID | test("^SPDXRef-[A-Za-z0-9.-]+$")) and (.name | length > 0) and (.downloadLocation | length > 0)
        and (.versionInfo | length > 0) and (.licenseDeclared | length > 0))
    and any(.relationships[]; .relationshipType == "DESCRIBES" and .relatedSpdxElement == "SPDXRef-facet")
    and all(.relationships[]; [.spdxElementId, .relatedSpdxElement] - $ids - ["SPDXRef-DOCUMENT"] == [])' "$tmp/sbom.json" >/dev/null ||
    fail "not SPDX 2.3: $(cat "$tmp/sbom.json")"

for library in "$@"; do
    readelf -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\.so.*/\1/p'
done | sort -u >"$tmp/needed"
jq -r '.packages[].name | ascii_downcase | sub("^lib"; "")' "$tmp/sbom.json" >"$tmp/names"
while read -r file; do
    case $file in
    libc | libm | libgcc_s | libstdc++ | libdl | libpthread | ld-linux* | libfacet) continue ;; # of the system
    libIex-* | libImath-* | libIlmThread-*) name=openexr ;;
    libembree*) name=embree ;;
    libkissfft*) name=kissfft ;;
    libturbojpeg) name=jpeg-turbo ;;
    libz) name=zlib ;;
    libzstd) name=zstandard ;;
    libspng | libepoxy | libwebp | libdraco | libastcenc | libjansson | libdeflate) name=${file#lib} ;;
    libOpenEXR*) name=openexr ;;
    *) name=$file ;;
    esac
    grep -qx "$name" "$tmp/names" || fail "$file is linked, but not in the list of libraries (src/api/libraries.c)"
done <"$tmp/needed"
echo "sbom: $(wc -l <"$tmp/names") packages, every linked library among them"
