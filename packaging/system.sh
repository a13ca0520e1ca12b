# system.sh - a bare Debian 12 to test in, for scripts to source: system_create FOLDER makes FOLDER/system anew (the archive of
# debootstrap is kept), system_run COMMAND runs in it as root in /root, with mounts of its own.
system_create() {
    system=$1/system
    mkdir -p "$1"
    if [ ! -f "$1/base.tar" ]; then
        rm -rf "$system"
        debootstrap --variant=minbase bookworm "$system" "${MIRROR:-http://deb.debian.org/debian}" >"$1/debootstrap.log" 2>&1 ||
            { tail -n 5 "$1/debootstrap.log"; exit 1; }
        tar -C "$system" -cf "$1/base.part" . && mv "$1/base.part" "$1/base.tar"
    fi
    rm -rf "$system"
    mkdir -p "$system"
    tar -C "$system" -xf "$1/base.tar"
    # access to packages: host names, apt, certificates
    cp /etc/resolv.conf "$system/etc/resolv.conf"
    if [ -z "${MIRROR:-}" ]; then
        cp /etc/apt/sources.list "$system/etc/apt/" 2>/dev/null || true
        cp /etc/apt/sources.list.d/debian* "$system/etc/apt/sources.list.d/" 2>/dev/null || true
    fi
    grep -l Acquire /etc/apt/apt.conf.d/* 2>/dev/null | while read -r file; do cp "$file" "$system/etc/apt/apt.conf.d/"; done
    certificates=
    if [ -n "${NODE_EXTRA_CA_CERTS:-}" ]; then
        certificates=/root/certificates.crt
        cp "$NODE_EXTRA_CA_CERTS" "$system$certificates"
    fi
}

system_run() {
    unshare --mount --pid --fork sh -euc '
        mount --make-rprivate /
        mount -t proc proc "$1/proc"
        mount --rbind /dev "$1/dev"
        exec chroot "$1" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
            ${3:+NODE_EXTRA_CA_CERTS="$3"} sh -c "cd /root && $2"' sh "$system" "$1" "$certificates"
}
